// Skin, lips, cloth, and the inside of mouths without a known opening (others: mouth_vertex.glsl). Light is computed
// per vertex and only perturbed per pixel: the mesh is so fine that a software rasterizer shades several pixels
// outside every triangle for each one inside.
layout(location = kDetailTexcoord) in vec2 unrolled;

uniform float key_through;   // part of the key light that reaches occluded places anyway
uniform float sheen;         // strength of down (vellus hair), which catches light at the edges

void main() {
  vec3 world = TransformVertex();
  vec3 n = WorldNormal();
  vec3 v = normalize(eye - world);
  float openness = albedo_openness.a;
  float crease = CreaseDepth();

  // Occluded corners glow red, because the light that reaches them has passed through skin.
  float root = sqrt(openness);
  vec3 open = mix(vec3(1.0), vec3(1.0, sqrt(root), root), look_occlusion_redness) * openness;
  vec3 shadow = vec3(KeyShadow(world));
  shadow.gb *= shadow.gb * look_shadow_redness + (1.0 - look_shadow_redness);

  // The edge of the shadow is warm: most of the light there has travelled under the skin.
  float n_dot_l = dot(n, lamp_directions[0]);
  vec3 key_open = lamp_colours[0] * shadow * mix(open, vec3(1.0), key_through);
  vec3 key = key_open * Wrapped(n_dot_l, wrap);
  // The rim lamp reaches the outline only: the head occludes folds that face it.
  float away = 1.0 - max(dot(n, v), 0.0);
  vec3 behind = lamp_colours[2] * Wrapped(dot(n, lamp_directions[2]), wrap * look_rim_wrap);
  vec3 soft = Ambient(n) + lamp_colours[1] * Wrapped(dot(n, lamp_directions[1]), wrap) +
              behind * look_rim_on_skin *
                  mix(look_rim_facing, look_rim_at_outline, Ramp(look_rim_outline_edge, away));
  vec3 total = soft * open + key;

  vec3 h = normalize(lamp_directions[0] + v);
  float power = key_open.g * Ramp(look_relief_edge, n_dot_l) * look_relief_power / max(total.g, 1e-3);
  SetSlopes(n, h, power);
  shine.x = Fresnel(dot(h, v)) * openness * openness * shadow.g *
            clamp(n_dot_l * look_mirror_rise.x + look_mirror_rise.y, 0.0, 1.0) *
            Ramp(look_mirror_edge, dot(n, h));
  shine.y = crease;

  float g = max(dot(n, normalize(lamp_directions[1] + v)), 0.0);
  float g4 = g * g * g * g;
  shine.z = (lamp_colours[1].g * look_sheen_fill * g4 * g4 * g4 * g4 +
             (behind.g * look_sheen_rim + Ambient(n).g * look_sheen_room) * away * away * away) *
            openness * openness * sheen;

  light = Albedo() * total * (1.0 - look_crease_darkens * crease);
  detail_uv = detail_per_mm > 0.0 ? rest_position.xy * detail_per_mm : unrolled;
}
