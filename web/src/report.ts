// The moving part of a report: its scene stands in the page, compressed.

import { element } from "./dom";
import { offerPictures } from "./figures";
import { RunView } from "./run_view";
import { Scene } from "./scene";
import style from "./style.css";
import plotStyle from "uplot/dist/uPlot.min.css";

function inflated(id: string): Promise<ArrayBuffer> {
  const text = document.getElementById(id)?.textContent?.trim() ?? "";
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

async function start(): Promise<void> {
  const scene = new Scene(await inflated("scene"));
  document.head.append(element("style", {}, plotStyle + style));
  const view = new RunView(scene);
  const moving = document.getElementById("moving")!;
  if (view.viewer) moving.append(view.viewer.box);
  moving.append(view.worn);
  moving.hidden = false;
  offerPictures(document);
  document.getElementById("moving-gait")?.append(view.gait);
  document.documentElement.dataset["ready"] = "yes";
}

void start();
