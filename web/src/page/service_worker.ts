// Caches the page's files, so that it works without a network once it was loaded.

// The files and a hash of them all, inserted by the build.
declare const FILES: string[];
declare const VERSION: string;

interface Extendable extends Event {
  waitUntil(work: Promise<unknown>): void;
}

interface Fetching extends Extendable {
  request: Request;
  respondWith(response: Promise<Response>): void;
}

addEventListener("install", (event) => (event as Extendable).waitUntil(caches.open(VERSION).then((kept) => kept.addAll(FILES))));

addEventListener("activate", (event) => {
  const others = caches.keys().then((names) => names.filter((name) => name !== VERSION));
  (event as Extendable).waitUntil(others.then((names) => Promise.all(names.map((name) => caches.delete(name)))));
});

addEventListener("fetch", (event) => {
  const { request, respondWith } = event as Fetching;
  const kept = caches.match(request, { ignoreSearch: true }).then((found) => found ?? fetch(request));
  respondWith.call(event, kept);
});
