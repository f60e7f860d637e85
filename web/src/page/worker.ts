// Calls the program beside the page, so that the page stays awake.

import { call, type Call } from "./program";

onmessage = ({ data }: MessageEvent<{ module: WebAssembly.Module; order: Call }>) => {
  const answer = call(data.module, data.order, (told) => postMessage({ told }));
  const transfer = Object.values(answer.files).map((bytes) => bytes.buffer as ArrayBuffer);
  postMessage({ answer }, { transfer });
};
