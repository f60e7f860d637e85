// The flat maps of the page, linked with the bodies: a point picked on one is marked on all.

interface FlatMap {
  svg: SVGSVGElement;
  // From z and x, mm, to the picture, px.
  placing: DOMMatrix;
  ring?: SVGCircleElement;
}

export class FlatMaps {
  private readonly maps: FlatMap[];

  constructor(root: ParentNode, picked: (x: number, z: number) => void) {
    this.maps = [...root.querySelectorAll<SVGSVGElement>("svg[data-map]")].map(mapOf);
    for (const map of this.maps) {
      map.svg.style.cursor = "crosshair";
      map.svg.addEventListener("click", ({ clientX, clientY }) => {
        const toScreen = DOMMatrix.fromMatrix(map.svg.getScreenCTM() ?? undefined).multiply(map.placing);
        const { x: z, y: x } = new DOMPoint(clientX, clientY).matrixTransform(toScreen.inverse());
        picked(x, z);
      });
    }
  }

  // Marks the place x, z, mm, on every map.
  mark(x: number, z: number): void {
    for (const map of this.maps) {
      const at = new DOMPoint(z, x).matrixTransform(map.placing);
      map.ring ??= map.svg.appendChild(newRing());
      map.ring.setAttribute("cx", String(at.x));
      map.ring.setAttribute("cy", String(at.y));
    }
  }
}

// The attribute of the picture holds x at its top and z at its left, mm, their positions in it, px, and its scale.
function mapOf(svg: SVGSVGElement): FlatMap {
  const [xHigh, zLow, left, top, perMm] = svg.dataset["map"]!.split(" ").map(Number) as [number, number, number, number, number];
  return { svg, placing: new DOMMatrix([perMm, 0, 0, -perMm, left - zLow * perMm, top + xHigh * perMm]) };
}

function newRing(): SVGCircleElement {
  const ring = document.createElementNS("http://www.w3.org/2000/svg", "circle");
  ring.setAttribute("r", "5.5");
  ring.setAttribute("class", "picked-place");
  return ring;
}
