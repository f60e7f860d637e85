// The flat maps of the page, linked with the bodies: a point picked on one is marked on all.

interface FlatMap {
  svg: SVGSVGElement;
  // From the picture itself: x at its top and z at its left, mm; their positions in it, px; its scale.
  place: { xHigh: number; zLow: number; left: number; top: number; perMm: number };
  ring?: SVGCircleElement;
}

export class FlatMaps {
  private readonly maps: FlatMap[];

  constructor(root: ParentNode, picked: (x: number, z: number) => void) {
    this.maps = [...root.querySelectorAll<SVGSVGElement>("svg[data-map]")].map(mapOf);
    for (const map of this.maps) {
      map.svg.style.cursor = "crosshair";
      map.svg.addEventListener("click", (event) => {
        const place = placeOf(map, event);
        if (place) picked(...place);
      });
    }
  }

  // Marks the place x, z, mm, on every map.
  mark(x: number, z: number): void {
    for (const map of this.maps) {
      const { xHigh, zLow, left, top, perMm } = map.place;
      map.ring ??= map.svg.appendChild(newRing());
      map.ring.setAttribute("cx", String(left + (z - zLow) * perMm));
      map.ring.setAttribute("cy", String(top + (xHigh - x) * perMm));
    }
  }
}

function mapOf(svg: SVGSVGElement): FlatMap {
  const [xHigh, zLow, left, top, perMm] = svg.dataset["map"]!.split(" ").map(Number);
  return { svg, place: { xHigh: xHigh!, zLow: zLow!, left: left!, top: top!, perMm: perMm! } };
}

function placeOf({ svg, place }: FlatMap, event: MouseEvent): [number, number] | undefined {
  const drawn = svg.getScreenCTM();
  if (!drawn) return undefined;
  const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(drawn.inverse());
  return [place.xHigh - (y - place.top) / place.perMm, place.zLow + (x - place.left) / place.perMm];
}

function newRing(): SVGCircleElement {
  const ring = document.createElementNS("http://www.w3.org/2000/svg", "circle");
  ring.setAttribute("r", "5.5");
  ring.setAttribute("class", "picked-place");
  return ring;
}
