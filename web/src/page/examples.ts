// The cases of the repository that need no other file.

import ankle from "../../../cases/ankle.toml";
import creep from "../../../cases/creep.toml";
import knee from "../../../cases/stanmore-force.toml";
import kneeIso from "../../../cases/knee-iso-14243-1.toml";
import kneeLigaments from "../../../cases/knee-ligaments.toml";
import hip from "../../../cases/hip-iso.toml";
import hipAtEdge from "../../../cases/hip-edge-loading.toml";
import lumbarDisc from "../../../cases/lumbar-disc.toml";
import pin from "../../../cases/pin-on-disc.toml";

// The first line of a case names a schema file for editors on the disk.
const cases: [title: string, text: string][] = [
  ["Knee, Stanmore simulator", knee],
  ["Knee with creep", creep],
  ["Knee, ISO 14243-1", kneeIso],
  ["Knee on six axes, with ligaments", kneeLigaments],
  ["Hip, ISO 14242-1", hip],
  ["Hip with a steep cup, loaded at its edge", hipAtEdge],
  ["Lumbar disc, ISO 18192-1", lumbarDisc],
  ["Ankle, ISO 22622", ankle],
  ["Pin on disc", pin],
];

// Title and text of each; the first is that of the page at the start.
export const EXAMPLES = cases.map(([title, text]): [string, string] => [title, text.replace(/^#:schema.*\n/, "")]);
