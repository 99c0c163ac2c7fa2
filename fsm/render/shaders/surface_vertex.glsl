// Skin, lips, cloth, and the inside of mouths that do not say where they open (others:
// mouth_vertex.glsl). Light is worked out here and only bent per pixel: the mesh is so fine that a
// software rasterizer shades several pixels beside every triangle for each one in it.
layout(location = 4) in vec2 unrolled;
layout(location = 5) in vec4 creases;        // how much each shows here
layout(location = 6) in vec2 nose_and_left;  // that of the nose; to which part the left side creases

uniform vec3 wrap;           // how far light goes round, per channel
uniform float key_through;   // how much of the key light reaches occluded places all the same
uniform float sheen;         // down that catches light at the edges
uniform float saturation;
uniform vec3 lobes;          // strengths of a broad, a middle and a tight highlight
uniform float bump;          // depth of pores or threads
uniform float chroma;        // of the colour on the screen, less than 1 beside a faded photo
uniform float planar;        // 0: detail by the unrolled place; else repeats per millimetre
uniform vec3 head_up;        // unit, the direction of growing v on the skin
uniform vec4 crease_depths[2];  // right, left: forehead, glabella, crow's feet, nasolabial
uniform float nose_creases[2];

out vec2 place;   // in the detail textures
out vec3 light;   // all that is scattered, with the surface's colour
out vec4 slopes;  // what a slope to the right and up adds to light; the half vector's slopes
out vec3 shine;   // strength of highlights, depth of creases, light at the edge
// In software a uniform costs a pixel more than what its triangle brings along.
flat out vec4 finish;  // strengths of the highlights, depth of detail
flat out vec4 gleam;   // light that gleams; chroma

void main() {
  vec3 world = TransformVertex();
  vec3 n = WorldNormal();
  vec3 v = normalize(eye - world);
  float occlusion = albedo_occlusion.a;
  vec3 albedo = albedo_occlusion.rgb;
  albedo = max(mix(vec3(dot(albedo, vec3(0.3, 0.6, 0.1))), albedo, saturation), 0.0);

  float crease = dot(creases, mix(crease_depths[0], crease_depths[1], nose_and_left.y)) +
                 nose_and_left.x * mix(nose_creases[0], nose_creases[1], nose_and_left.y);

  // Corners shut off from light glow red, because what light there is came through skin.
  float root = sqrt(occlusion);
  vec3 open = mix(vec3(1.0), vec3(1.0, sqrt(root), root), occlusion_redness) * occlusion;
  vec3 shadow = vec3(KeyShadow(world));
  shadow.gb *= shadow.gb * 0.08 + 0.92;

  // The edge of the shadow is warm: there most of what is seen went some way under the skin.
  float n_dot_l = dot(n, lamp_directions[0]);
  vec3 key_open = lamp_colors[0] * shadow * mix(open, vec3(1.0), key_through);
  vec3 key = key_open * Wrapped(n_dot_l, wrap);
  // The lamp behind only reaches the outline: folds that face it are shut off by the head.
  float away = 1.0 - max(dot(n, v), 0.0);
  vec3 soft = Ambient(n) + lamp_colors[1] * Wrapped(dot(n, lamp_directions[1]), wrap) +
              lamp_colors[2] * rim_on_skin * mix(rim_facing, rim_at_outline, smoothstep(0.25, 0.85, away)) *
                  Wrapped(dot(n, lamp_directions[2]), wrap * 0.6);
  vec3 total = soft * open + key;

  vec3 right = normalize(cross(head_up, n) + vec3(1e-5, 0.0, 0.0));
  vec3 up = cross(n, right);
  float power = key_open.g * smoothstep(-0.35, 0.15, n_dot_l) * 0.8 / max(total.g, 1e-3);
  slopes.xy = -power * vec2(dot(right, lamp_directions[0]), dot(up, lamp_directions[0]) + 0.12);

  vec3 h = normalize(lamp_directions[0] + v);
  slopes.zw = vec2(dot(right, h), dot(up, h));
  shine.x = Fresnel(dot(h, v)) * occlusion * occlusion * shadow.g *
            clamp(n_dot_l * 4.0 + 0.2, 0.0, 1.0) * smoothstep(0.0, 0.3, dot(n, h));
  shine.y = crease;

  float g = max(dot(n, normalize(lamp_directions[1] + v)), 0.0);
  float g4 = g * g * g * g;
  shine.z = (lamp_colors[1].g * down_fill * g4 * g4 * g4 * g4 +
             (lamp_colors[2].g * down_rim + Ambient(n).g * down_room) * away * away * away) *
            occlusion * occlusion * sheen;

  finish = vec4(lobes, bump);
  gleam = vec4(lamp_colors[0], chroma);
  light = albedo * total * (1.0 - crease_darkens * crease);
  place = planar > 0.0 ? rest_position.xy * planar : unrolled;
}
