// The interactive part of a report, whose scene stands in the page, compressed.

import { element } from "./dom";
import { offerPictures, standalone } from "./figures";
import { RunView } from "./run_view";
import { Scene, type Chart } from "./scene";
import style from "./style.css";
import plotStyle from "uplot/dist/uPlot.min.css";

// Charts that stand next to the bodies.
const NEXT_TO_BODIES = ["w-mass_loss_mg", "w-max_depth_mm"];

function inflated(id: string): Promise<ArrayBuffer> {
  const text = document.getElementById(id)?.textContent?.trim() ?? "";
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

// The still picture of a chart, which the interactive one replaces on the screen.
function stillOf({ id }: Chart): SVGSVGElement | undefined {
  const all = [...document.querySelectorAll<SVGSVGElement>("svg[data-chart]")];
  return all.find(({ dataset }) => dataset["chart"] === id);
}

async function start(): Promise<void> {
  const scene = new Scene(await inflated("scene"));
  document.head.append(element("style", {}, plotStyle + style));
  const svgOf = (chart: Chart) => {
    const still = stillOf(chart);
    return still && (() => standalone(still));
  };
  const view = new RunView(scene, { svgOf });
  const worn = element("div", { class: "worn" });
  for (const plot of view.plots) {
    const still = stillOf(plot.chart);
    still?.classList.add("still");
    if (view.viewer && NEXT_TO_BODIES.includes(plot.chart.id)) worn.append(plot.box);
    else still?.after(plot.box);
  }
  worn.append(view.history);
  const moving = document.getElementById("moving")!;
  if (view.viewer) moving.append(view.viewer.box, worn);
  moving.hidden = !view.viewer;
  offerPictures(document);
  document.documentElement.dataset["ready"] = "yes";
}

void start();
