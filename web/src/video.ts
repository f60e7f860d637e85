// A video of a canvas that is painted frame by frame, encoded by the browser while it is painted.

// The first that the browser can encode; presentations show MP4.
const TYPES = ["video/mp4;codecs=avc1.640028", "video/webm;codecs=vp9", "video/webm"];
const FRAMES_A_SECOND = 25;
const BITS_A_SECOND = 8e6;

// The type of the videos; undefined if the browser makes none.
export function typeOfVideo(): string | undefined {
  return typeof MediaRecorder === "undefined" ? undefined : TYPES.find((type) => MediaRecorder.isTypeSupported(type));
}

// Paints for a number of seconds; `paint` gets the part of them that has passed. A slow machine paints fewer frames.
export async function video(canvas: HTMLCanvasElement, seconds: number, paint: (part: number) => void): Promise<Blob> {
  const type = typeOfVideo()!;
  const recorder = new MediaRecorder(canvas.captureStream(FRAMES_A_SECOND), { mimeType: type, videoBitsPerSecond: BITS_A_SECOND });
  const pieces: Blob[] = [];
  recorder.addEventListener("dataavailable", ({ data }) => pieces.push(data));
  const stopped = new Promise((done) => recorder.addEventListener("stop", done));
  paint(0);
  recorder.start();
  const began = performance.now();
  for (let part = 0; part < 1; ) {
    await new Promise((done) => setTimeout(done, 1000 / FRAMES_A_SECOND));
    part = Math.min(1, (performance.now() - began) / 1000 / seconds);
    paint(part);
  }
  recorder.stop();
  await stopped;
  return new Blob(pieces, { type: type.split(";")[0]! });
}
