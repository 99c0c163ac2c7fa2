// Metallic-roughness shading (glTF 2.0, appendix B: Lambert and GGX), or the two colours of a toon material
// (VRMC_materials_mtoon 1.0, "Lighting").
in vec3 at;
in vec3 facing;
in vec3 texcoord;  // u, v down; z > 0: the picture has the colour
in vec3 tint;  // factor on the picture, or the colour without one

uniform float brightness;
uniform bool cut_out;       // alpha test: transparent pixels are discarded
uniform bool toon;         // two-colour shading
uniform float metallic;
uniform float roughness;
uniform float shade_to;    // cosines of the light's angle: shade colour up to here,
uniform float light_from;  // lit colour from here
uniform vec3 emissive;
uniform vec3 shade_colour;
uniform sampler2D base_colour;
uniform sampler2D normal_roughness_metal;   // xy of the normal, roughness, metallic
uniform sampler2D emission_openness; // emission, or the toon's shade colour; a: openness to light

out vec4 colour;

// Materials expect light in which white appears white; under our lamps and room a white plate that faces the viewer
// appears twice as bright.
const float kPlate = 0.52;

// Returns the normal bent by the map, in the tangent frame found from the screen-space derivatives of position and
// texture coordinate (Schueler, "Followup: Normal Mapping Without Precomputed Tangents", 2013).
vec3 Bent(vec3 n, vec2 slope) {
  vec3 dx = dFdx(at), dy = dFdy(at);
  vec2 ux = dFdx(texcoord.xy), uy = dFdy(texcoord.xy);
  vec3 across = cross(dy, n), along = cross(n, dx);
  vec3 right = across * ux.x + along * uy.x;
  vec3 down = across * ux.y + along * uy.y;
  float size = inversesqrt(max(max(dot(right, right), dot(down, down)), 1e-20));
  float z = sqrt(max(1.0 - dot(slope, slope), 0.0));
  return normalize(right * size * slope.x - down * size * slope.y + n * z);
}

// Specular reflection of a lamp without its Fresnel term: GGX with Smith's shadowing.
float Mirrored(float n_h, float n_l, float n_v, float a2) {
  float d = n_h * n_h * (a2 - 1.0) + 1.0;
  float v = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
  return a2 / (d * d) * 0.5 / max(v, 1e-3);
}

void main() {
  vec4 p = texture(base_colour, texcoord.xy);
  if (texcoord.z > 0.0 && cut_out && 1.0 - p.a > OpacityStep(gl_FragCoord.xy) && p.a < 0.98) discard;
  vec3 base = texcoord.z > 0.0 ? ToLinear(p.rgb) * tint : tint;
  vec4 r = texcoord.z > 0.0 ? texture(normal_roughness_metal, texcoord.xy) : vec4(0.5, 0.5, 1.0, 1.0);
  vec4 l = texcoord.z > 0.0 ? texture(emission_openness, texcoord.xy) : vec4(1.0);

  vec3 n = normalize(facing);
  if (!gl_FrontFacing) n = -n;
  vec2 slope = (r.xy * 255.0 - 128.0) / 127.0;
  if (dot(slope, slope) > 1e-3) n = Bent(n, slope);
  if (toon) {
    float lit = clamp((dot(n, lamp_directions[0]) - shade_to) / max(light_from - shade_to, 1e-3),
                      0.0, 1.0);
    vec3 drawn = mix(shade_colour * ToLinear(l.rgb) * tint, base, lit) + emissive;
    colour = vec4(FromLinear(drawn) * brightness, 1.0);
    return;
  }
  vec3 v = normalize(eye - at);
  float metal = metallic * r.w, rough = clamp(roughness * r.z, 0.05, 1.0);
  vec3 f0 = mix(vec3(0.04), base, metal), scatters = base * (1.0 - metal);
  float a2 = rough * rough * rough * rough;
  float n_v = max(dot(n, v), 1e-3);
  float shadow = KeyShadow(at);
  vec3 light = vec3(0.0);
  for (int i = 0; i < 3; ++i) {
    float n_l = dot(n, lamp_directions[i]);
    if (n_l <= 0.0) continue;
    vec3 h = normalize(lamp_directions[i] + v);
    float c = 1.0 - clamp(dot(h, v), 0.0, 1.0);
    vec3 fresnel = f0 + (1.0 - f0) * c * c * c * c * c;
    // A lamp's colour is the light that white reflects when it faces the lamp.
    vec3 falls = lamp_colours[i] * n_l * (i == 0 ? shadow : 1.0);
    light += falls * ((1.0 - fresnel) * scatters +
                      fresnel * Mirrored(max(dot(n, h), 0.0), n_l, n_v, a2));
  }
  // A rough surface reflects little of the room (Lazarov's fit of the split sum, 2013).
  vec4 q = rough * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float e = min(q.x * q.x, exp2(-9.28 * n_v)) * q.x + q.y;
  vec3 room = f0 * (-1.04 * e + q.z) + (1.04 * e + q.w);
  light += l.a * (Ambient(n) * scatters + Ambient(reflect(-v, n)) * room);
  light *= kPlate;
  light += emissive * ToLinear(l.rgb) / look_exposure;
  colour = vec4(ToScreen(light), 1.0);
}
