// Calls the program in a worker, so that the page stays responsive.

import { call, type Call } from "./program";

addEventListener("message", ({ data }: MessageEvent<{ module: WebAssembly.Module; order: Call }>) => {
  const answer = call(data.module, data.order, (message) => postMessage({ message }));
  const transfer = Object.values(answer.files).map((bytes) => bytes.buffer as ArrayBuffer);
  postMessage({ answer }, { transfer });
});
