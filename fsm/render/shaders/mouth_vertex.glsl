// Teeth, gums, tongue and lining of the mouth. Light enters between the lips, and deeper between the teeth; this
// shader computes how much of it arrives, and from where, for the current shape of the mouth. surface_fragment.glsl
// adds detail and highlights. kColumns is that of MouthFinder.
const int kRing = 2 * kColumns + 2;

uniform bool lining;                 // walls, which are seen from within
uniform float front_gain;            // factors on the light that the lamps bring in: on the teeth,
uniform float deep_gain;             // and behind them
uniform mat4 to_mouth;               // from the figure's frame: x along the lips, y up, z out
uniform mat3 mouth_to_world;         // for directions
uniform vec3 lips[2 * kColumns];     // upper edge from -x to +x, then the lower one
uniform vec4 mouth_edges;            // x of the corners (y = z = 0), heights of the upper and lower teeth's edges
uniform vec3 mouth_key;              // towards the key light, in the mouth's frame

vec3 RingAt(int i, float deep) {
  if (i == 0) return vec3(mouth_edges.x, 0.0, 0.0);
  if (i == kColumns + 1) return vec3(mouth_edges.y, 0.0, 0.0);
  // One index serves both edges: NVIDIA's compiler unrolls the loop and rejects an index that is out of bounds even
  // where it is never reached.
  bool upper = i > kColumns;
  vec3 p = lips[upper ? kRing - 1 - i : kColumns + i - 1];
  float behind = upper ? min(p.y, mouth_edges.z) : max(p.y, mouth_edges.w);
  return vec3(p.x, mix(p.y, behind, deep), p.z);
}

// Returns the irradiance from all directions through the opening, as a vector: its dot product with a normal is the
// light on that surface, 1 if it sees the outside only. After Lambert (1760): sum over the polygon's edges of the
// angle each subtends, along the normal of the plane through the edge and the point.
vec3 ThroughLips(vec3 p, float deep) {
  vec3 sum = vec3(0.0);
  vec3 a = normalize(RingAt(kRing - 1, deep) - p);
  for (int i = 0; i < kRing; ++i) {
    vec3 b = normalize(RingAt(i, deep) - p);
    vec3 c = cross(a, b);
    float s = length(c);
    sum += c * (s > 1e-4 ? acos(clamp(dot(a, b), -1.0, 1.0)) / s : 1.0);
    a = b;
  }
  return sum / 6.2831853;
}

// Returns y and z of the upper edge (first = 0) or the lower edge (kColumns) at one x; the third component is the
// total weight of the samples.
vec3 EdgeAt(int first, float x) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < kColumns; ++i) {
    vec3 p = lips[first + i];
    float d = (p.x - x) / 3.5;
    sum += vec3(p.yz, 1.0) * exp(-d * d);
  }
  return vec3(sum.xy / max(sum.z, 1e-4), sum.z);
}

void main() {
  vec3 world = TransformVertex();
  vec3 n_world = WorldNormal();
  vec3 v = normalize(eye - world);
  vec3 p = (to_mouth * vec4(position, 1.0)).xyz;
  vec3 n = mat3(to_mouth) * normal;
  float openness = albedo_openness.a;

  vec3 upper = EdgeAt(0, p.x);
  vec3 lower = EdgeAt(kColumns, p.x);
  float height = clamp((p.y - lower.x) / max(upper.x - lower.x, 1.0), 0.0, 1.0);
  float inward = mix(lower.y, upper.y, height) - p.z;
  // Nostrils have the lining of the mouth.
  float out_of_mouth = max(Ramp(look_nostril_before, inward), Ramp(look_nostril_above, p.y - upper.x));
  float deep = Ramp(look_mouth_deep_edge, inward);

  vec3 flow = mix(ThroughLips(p, deep), vec3(0.0, 0.0, 1.0), out_of_mouth);
  float amount = length(flow);
  vec3 from = amount > 1e-4 ? flow / amount : vec3(0.0, 0.0, 1.0);
  // The space before the mouth, lit by the lamps as the face is.
  vec3 sky = Ambient(mouth_to_world * from) + look_mouth_room * (lamp_colours[0] + lamp_colours[1]);
  vec3 soft = sky * amount * Wrapped(dot(from, n), wrap);
  // Light that bounces between the walls is red.
  vec3 red = mix(vec3(1.0), look_through_flesh, lining ? 1.0 : look_teeth_bounced_red);
  vec3 bounced = sky * red * sqrt(amount + look_mouth_seeps) * look_mouth_bounced *
                 mix(look_mouth_bounced_front, 1.0, Ramp(look_mouth_bounced_front_edge, inward)) *
                 mix(1.0, look_mouth_bounced_throat, Ramp(look_mouth_bounced_throat_edge, inward)) *
                 (1.0 - out_of_mouth);

  // The key lamp shines in past the edges of the lips, which cast a soft shadow.
  vec2 reach = max(vec2(upper.y, lower.y) - p.z, 0.0) / max(mouth_key.z, 0.3);
  vec2 blur = look_lip_shadow_blur.x + look_lip_shadow_blur.y * reach;
  upper = EdgeAt(0, p.x + mouth_key.x * reach.x);
  lower = EdgeAt(kColumns, p.x + mouth_key.x * reach.y);
  upper.x = mix(upper.x, min(upper.x, mouth_edges.z), deep);
  lower.x = mix(lower.x, max(lower.x, mouth_edges.w), deep);
  float lit = smoothstep(-blur.x, blur.x, upper.x - p.y - mouth_key.y * reach.x) *
              smoothstep(-blur.y, blur.y, p.y + mouth_key.y * reach.y - lower.x) *
              smoothstep(0.05, 0.6, min(upper.z, lower.z));
  lit = mix(lit, 1.0, out_of_mouth);
  float n_dot_l = dot(n, mouth_key);
  float shadow = KeyShadow(world) * lit;
  vec3 key = lamp_colours[0] * shadow * Wrapped(n_dot_l, wrap);

  vec3 total = soft + key;
  float facing = Ramp(look_mouth_outline_edge, dot(n_world, v));
  float outline = lining ? 1.0 : mix(look_mouth_outline, 1.0, facing);
  float open = mix(mix(sqrt(openness), 1.0, lining ? look_lining_open : 0.0), openness * openness, out_of_mouth);
  light = Albedo() * (total * open * outline + bounced * mix(look_mouth_bounced_shut, 1.0, open)) *
          mix(front_gain, deep_gain, Ramp(look_mouth_front_edge, inward));

  float power = lamp_colours[0].g * shadow * Ramp(look_relief_edge, n_dot_l) * look_relief_power /
                max(total.g, 1e-3);
  vec3 h = normalize(mouth_to_world * mouth_key + v);
  SetSlopes(n_world, h, power);
  shine.x = Fresnel(dot(h, v)) * openness * openness * shadow * Ramp(look_mirror_edge, dot(n_world, h));
  shine.yz = vec2(0.0);
  detail_uv = rest_position.xz * detail_per_mm;
}
