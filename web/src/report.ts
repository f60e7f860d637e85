// The interactive part of a report, and of several runs side by side; the scenes stand in the page, compressed.

import { chartSvg } from "./chart_svg";
import { element } from "./dom";
import { offerPictures, standalone } from "./figures";
import { linked } from "./linked";
import { RunView } from "./run_view";
import { piped } from "./save";
import { Scene, type Chart } from "./scene";
import style from "./style.css";
import { Viewer } from "./viewer";
import plotStyle from "uplot/dist/uPlot.min.css";

async function sceneOf(host: HTMLElement): Promise<Scene> {
  const text = document.getElementById(host.dataset["scene"]!)?.textContent?.trim() ?? "";
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Scene((await piped(bytes, new DecompressionStream("deflate"))).buffer);
}

// The still picture of a chart, which the interactive one replaces on the screen.
function stillOf({ id }: Chart): SVGSVGElement | null {
  return document.querySelector(`svg[data-chart="${CSS.escape(id)}"]`);
}

function showRun(host: HTMLElement, scene: Scene): void {
  const view = new RunView(scene);
  view.draw((chart) => {
    const still = stillOf(chart);
    return still ? standalone(still) : chartSvg(chart);
  });
  for (const plot of view.plots) {
    const still = stillOf(plot.chart);
    still?.classList.add("still");
    still?.after(plot.box);
  }
  if (view.viewer) host.append(view.viewer.box, view.history);
  host.hidden = !view.viewer;
}

async function start(): Promise<void> {
  const hosts = [...document.querySelectorAll<HTMLElement>("[data-scene]")];
  const scenes = await Promise.all(hosts.map(sceneOf));
  document.head.append(element("style", {}, plotStyle + style));
  if (hosts.length === 1) showRun(hosts[0]!, scenes[0]!);
  else {
    const viewers = scenes.map((scene) => (scene.facts.updates.length ? new Viewer(scene) : undefined));
    viewers.forEach((viewer, index) => viewer && hosts[index]!.append(viewer.box));
    linked(viewers.filter((viewer) => viewer !== undefined));
  }
  offerPictures(document);
  // What is folded away on the screen is printed.
  addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((details) => (details.open = true)));
  document.documentElement.dataset["ready"] = "yes";
}

void start();
