// Colour maps with evenly rising lightness, readable by colour-blind people and in grey.

export type MapName = "viridis" | "cividis";

// Ninths of the maps of matplotlib (viridis: van der Walt and Smith 2015; cividis: Nuñez, Anderton and Renslow 2018).
const STOPS: Record<MapName, number[]> = {
  viridis: [0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725],
  cividis: [0x00224e, 0x0f326c, 0x3a4a6c, 0x575d6d, 0x707173, 0x8a8678, 0xa69d75, 0xc4b56c, 0xe4cf5b, 0xfee838],
};

const LEVELS = 256;

function parts(colour: number): [number, number, number] {
  return [(colour >> 16) & 255, (colour >> 8) & 255, colour & 255];
}

// Converts a part of an sRGB colour to linear light (IEC 61966-2-1).
function linear(part: number): number {
  const share = part / 255;
  return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
}

function table(name: MapName): Float32Array {
  const stops = STOPS[name];
  const colours = new Float32Array(3 * LEVELS);
  for (let level = 0; level < LEVELS; level++) {
    const place = (level / (LEVELS - 1)) * (stops.length - 1);
    const below = Math.min(Math.floor(place), stops.length - 2);
    const [from, to] = [parts(stops[below]!), parts(stops[below + 1]!)];
    for (let part = 0; part < 3; part++) {
      colours[3 * level + part] = linear(from[part]! + (to[part]! - from[part]!) * (place - below));
    }
  }
  return colours;
}

const TABLES: Record<MapName, Float32Array> = { viridis: table("viridis"), cividis: table("cividis") };

// Colours values between two ends, in linear red, green and blue.
export function paint(values: ArrayLike<number>, [low, high]: [number, number], map: MapName, into: Float32Array): void {
  const colours = TABLES[map];
  const scale = (LEVELS - 1) / (high > low ? high - low : 1);
  for (let i = 0; i < values.length; i++) {
    const level = 3 * Math.max(0, Math.min(LEVELS - 1, Math.round((values[i]! - low) * scale)));
    into[3 * i] = colours[level]!;
    into[3 * i + 1] = colours[level + 1]!;
    into[3 * i + 2] = colours[level + 2]!;
  }
}

// The map as a CSS gradient from left to right.
export function gradient(map: MapName): string {
  const stops = STOPS[map].map((colour) => `#${colour.toString(16).padStart(6, "0")}`);
  return `linear-gradient(to right, ${stops.join(", ")})`;
}
