// Precedes every shader that lights something: lamps, shadows and tone mapping. World coordinates are in millimetres,
// light is linear. The version and the numbers of tables/appearance.txt, as constants, come before it:
// look_sky_colour, look_exposure, ...
uniform vec3 eye;

// Smooth step from 0 at the first number of an edge of the table to 1 at the second.
float Ramp(vec2 edge, float x) { return smoothstep(edge.x, edge.y, x); }

// Two ellipsoids approximate the shadows that the head casts on itself: the head casts on neck and shoulders, the
// nose on a cheek. Each matrix maps the world so that its ellipsoid is the unit sphere; each vector is the direction
// of the key light in that space.
uniform mat4 occluders[2];
uniform vec3 occluder_lights[2];

// Unit vectors towards the lamps, and their light: key, fill, rim.
uniform vec3 lamp_directions[3];
uniform vec3 lamp_colours[3];

const float kShadowDepth[2] = float[2](look_head_shadow, look_nose_shadow);

// Returns the part of the key light that passes the ellipsoids: the closer the ray to one, the less, with the broad
// penumbra of a large lamp.
float KeyShadow(vec3 world) {
  float lit = 1.0;
  for (int i = 0; i < 2; ++i) {
    vec3 p = (occluders[i] * vec4(world, 1.0)).xyz;
    float ahead = -dot(p, occluder_lights[i]);
    float nearest = sqrt(max(dot(p, p) - ahead * ahead, 0.0));
    lit *= 1.0 - kShadowDepth[i] * smoothstep(0.05, 0.5, ahead) *
                     (1.0 - Ramp(look_shadow_edge.yx, nearest));
  }
  return lit;
}

vec3 Ambient(vec3 n) { return mix(look_ground_colour, look_sky_colour, 0.5 + 0.5 * n.y); }

// Wrapped diffuse light: it approximates subsurface scattering, further for red than for blue, as `wrap` says. It is
// normalized, so that softer does not mean brighter, and fades out smoothly, since a kink in its slope would be
// visible as a line.
vec3 Wrapped(float n_dot_l, vec3 wrap) {
  const float kSoft = 0.4;
  vec3 x = (n_dot_l + wrap) / (1.0 + wrap);
  vec3 t = clamp(x / kSoft, 0.0, 1.0);
  return (max(x - kSoft, 0.0) + 0.5 * kSoft * t * t) / ((1.0 - 0.5 * kSoft) * (1.0 + wrap));
}

// Returns the reflectance at refractive index about 1.4 by the cosine of the angle (Schlick 1994).
float Fresnel(float cosine) {
  float c = 1.0 - clamp(cosine, 0.0, 1.0);
  float c2 = c * c;
  return 0.028 + 0.972 * c2 * c2 * c;
}

// Tone mapping: linear light to the screen. A filmic curve (Narkowicz's fit of ACES) followed by sRGB's, both fitted
// by one ratio over the square root of light; the error is below 0.006, the cost a fifth.
vec3 ToScreen(vec3 light) {
  vec3 x = light * look_exposure;
  vec3 s = sqrt(x);
  return (5.547 * x - 0.0477 * s) / (1.0 - 0.6045 * s + 5.653 * x);
}

// Convert picture colours to linear light and back.
vec3 ToLinear(vec3 shown) { return pow(shown, vec3(2.2)); }
vec3 FromLinear(vec3 light) { return pow(light, vec3(1.0 / 2.2)); }

// Alpha to coverage: each of a pixel's four samples compares the opacity with another threshold, so that partial
// opacity becomes the share of samples that are kept.
float OpacityStep(vec2 sample_place) {
  ivec2 s = ivec2(sample_place) & 1;
  return (float(s.x ^ s.y) * 2.0 + float(s.y) + 0.5) / 4.0;
}
