// Saves the still pictures of the page as SVG on white and as PNG.

import { button, element } from "./dom";
import { slug } from "./plots";
import { save, savePicture } from "./save";

// Pixels of a PNG for each point of the picture.
const DOTS = 2;

// Puts two buttons below every still picture that is on the screen.
export function offerPictures(root: ParentNode): void {
  for (const svg of root.querySelectorAll<SVGSVGElement>("svg.fig:not(.still)")) {
    const name = slug(svg.querySelector("title")?.textContent ?? "") || "picture";
    const saves = element(
      "span",
      { class: "saves" },
      button("SVG", () => save(`${name}.svg`, new Blob([standalone(svg)], { type: "image/svg+xml" }))),
      button("PNG", () => void savePng(`${name}.png`, svg)),
    );
    const box = element("span", { class: "figure-box" });
    svg.replaceWith(box);
    box.append(svg, saves);
  }
}

// The picture as a file of its own: on white, with its style inside.
export function standalone(svg: SVGSVGElement): string {
  const copy = svg.cloneNode(true) as SVGSVGElement;
  const { width, height } = svg.viewBox.baseVal;
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", String(width));
  copy.setAttribute("height", String(height));
  const style = document.createElementNS("http://www.w3.org/2000/svg", "style");
  style.textContent = pictureRules();
  const paper = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  for (const [key, value] of Object.entries({ width, height, fill: "#fff" })) paper.setAttribute(key, String(value));
  copy.prepend(style, paper);
  return new XMLSerializer().serializeToString(copy);
}

// The rules of the page for pictures, and its colours on white.
function pictureRules(): string {
  const rules = [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules]);
  const kept = rules.filter((rule) => rule instanceof CSSStyleRule && /^:root$|\.fig\b/.test(rule.selectorText));
  return kept.map((rule) => rule.cssText).join("\n");
}

async function savePng(name: string, svg: SVGSVGElement): Promise<void> {
  const image = new Image();
  const { width, height } = svg.viewBox.baseVal;
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(standalone(svg))}`;
  await image.decode();
  const canvas = element("canvas", { width: DOTS * width, height: DOTS * height });
  canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
  savePicture(name, canvas);
}
