// The material of the bodies, lit at their vertices, which a processor can do thirty times a second.

import { Color, GLSL3, RawShaderMaterial, Vector3, type Side } from "three";

export interface Look {
  // Each vertex has its own colour if not given.
  colour?: number;
  // Without lighting: one colour everywhere.
  isFlat?: boolean;
  isGlass?: boolean;
  side: Side;
}

// Beyond every body, mm: no section.
const FAR_MM = 1e6;

// Light from above and from the ground, and a lamp next to the eye; colours are added in linear light.
const CORNERS = `
precision highp float;
uniform mat4 modelMatrix, viewMatrix, modelViewMatrix, projectionMatrix;
uniform mat3 normalMatrix;
uniform vec3 tint;
in vec3 position, normal;
#ifdef OWN_COLOURS
in vec3 color;
#endif
#ifdef CUT
out vec3 place;
#endif
out vec3 shade;
const vec3 LAMP = vec3(0.298, 0.596, 0.745);
const vec3 GROUND = vec3(0.26, 0.24, 0.22);
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
#ifdef CUT
  place = (modelMatrix * vec4(position, 1.0)).xyz;
#endif
  vec3 own = tint;
#ifdef OWN_COLOURS
  own = color;
#endif
#ifndef FLAT
  vec3 up = normalize(normalMatrix * normal);
#ifdef BOTH_SIDES
  if (dot(up, seen.xyz) > 0.0) up = -up;
#endif
  float sky = 0.5 + 0.5 * dot(up, viewMatrix[1].xyz);
  own *= 0.54 * mix(GROUND, vec3(1.0), sky) + 0.51 * max(dot(up, LAMP), 0.0);
#endif
  shade = pow(min(own, 1.0), vec3(1.0 / 2.2));
}`;

const DOTS = `
precision mediump float;
uniform float opacity;
#ifdef CUT
uniform highp vec3 cut;
in highp vec3 place;
#endif
in vec3 shade;
out vec4 dot_;
void main() {
#ifdef CUT
  if (place.x > cut.x || place.z > cut.z) discard;
#endif
  dot_ = vec4(shade, opacity);
}`;

export class Matter extends RawShaderMaterial {
  constructor({ colour, isFlat, isGlass, side }: Look) {
    super({
      glslVersion: GLSL3,
      vertexShader: CORNERS,
      fragmentShader: DOTS,
      uniforms: {
        tint: { value: new Color(colour ?? 0xffffff) },
        opacity: { value: 1 },
        cut: { value: new Vector3(FAR_MM, FAR_MM, FAR_MM) },
      },
      defines: {
        ...(colour === undefined ? { OWN_COLOURS: 1 } : {}),
        ...(isFlat ? { FLAT: 1 } : {}),
        ...(isGlass ? { BOTH_SIDES: 1 } : {}),
      },
      side,
      transparent: isGlass ?? false,
      // Faces behind show through as well as faces in front.
      forceSinglePass: true,
    });
  }

  // Removes everything beyond x or z, mm.
  cutAt(x = FAR_MM, z = FAR_MM): void {
    (this.uniforms["cut"]!.value as Vector3).set(x, FAR_MM, z);
    const isCut = x < FAR_MM || z < FAR_MM;
    if (isCut === "CUT" in this.defines) return;
    if (isCut) this.defines["CUT"] = 1;
    else delete this.defines["CUT"];
    this.needsUpdate = true;
  }

  // Red, green and blue in linear light.
  get rgb(): [number, number, number] {
    const { r, g, b } = this.uniforms["tint"]!.value as Color;
    return [r, g, b];
  }

  get opacityShown(): number {
    return this.uniforms["opacity"]!.value as number;
  }

  seeThrough(opacity: number): void {
    this.uniforms["opacity"]!.value = opacity;
    this.depthWrite = opacity === 1;
  }
}
