// Hair, brows and lashes.
layout(location = kDetailTexcoord) in vec2 among_hairs;  // millimetres across and along the hairs
layout(location = kDetail) in vec4 along_and_density;    // direction at rest, whose length tells how sleek the hair is,
                                                         // 0..1; density, 1 = dense .. 0 = none
layout(location = kDetailMore) in vec2 across_lock;      // -1..1; 1 if hair thins out at the outline

uniform mat3 rest_to_world;  // rotation of the head
uniform float streaks;       // how strongly strands differ; 0 for lashes
uniform float shine;

out vec2 streak_uv;
out vec2 fray;      // density, position across the lock
out vec3 light;     // scattered light, with the hair's colour
out vec3 key_light; // light of the key lamp that passed through hair
out vec3 tilt;      // half vector along the strand and along the normal; strength of the reflection
flat out vec4 gleam;  // reflected light; how strongly strands differ

void main() {
  vec3 world = TransformVertex();
  vec3 n = WorldNormal();
  vec3 v = normalize(eye - world);
  // At its outline hair is thin, so that single hairs are visible there and no edge of a sheet is; behind it nothing is
  // seen of the far side.
  float thin = clamp(dot(n, v) * look_hair_outline.x + look_hair_outline.y, 0.0, 1.0);
  // Sheets are visible from both sides; at the outline they keep the side they face.
  n -= 2.0 * min(dot(n, v), 0.0) * v;
  vec3 albedo = albedo_openness.rgb;
  float openness = albedo_openness.a;

  vec3 strand = rest_to_world * along_and_density.xyz;
  float sleek = length(strand);
  strand = normalize(strand - n * dot(strand, n) + n * 1e-4);
  streak_uv = among_hairs * vec2(1.0 / 268.0, 1.0 / 256.0);
  fray = vec2(along_and_density.w * mix(1.0, thin, across_lock.y), across_lock.x);

  // Light on a strand is proportional to the sine of its angle to it (Kajiya and Kay 1989).
  float shadow = mix(openness, 1.0, look_hair_open_least) * mix(KeyShadow(world), 1.0, look_hair_lit_least);
  float t_dot_l = dot(strand, lamp_directions[0]);
  float across = look_hair_end_on + (1.0 - look_hair_end_on) * sqrt(max(1.0 - t_dot_l * t_dot_l, 0.0));
  float fill = max((dot(n, lamp_directions[1]) + look_hair_wrap.x) / look_hair_wrap.y, 0.0);
  vec3 soft = albedo * openness * (Ambient(n) + lamp_colours[1] * fill);
  float rim = clamp(dot(n, lamp_directions[2]) * look_hair_rim_wrap.x + look_hair_rim_wrap.y, 0.0, 1.0);
  float away = 1.0 - max(dot(n, v), 0.0);
  // Dark hairs (lashes) must not glitter at grazing angles.
  vec3 sheen = min(vec3(look_hair_rim_sheen), albedo) * away * away;
  soft += lamp_colours[2] * openness * rim * (albedo * look_hair_rim + sheen);
  float n_dot_l = dot(n, lamp_directions[0]);
  vec3 key = lamp_colours[0] * shadow * albedo * max((n_dot_l + look_hair_wrap.x) / look_hair_wrap.y, 0.0) * across;
  light = soft + key;
  key_light = shine * sleek * look_hair_through_part * key;
  gleam = vec4(shine * sleek * lamp_colours[0], streaks);
  vec3 h = normalize(lamp_directions[0] + v);
  float lit = clamp(n_dot_l * look_hair_mirrored_rise.x + look_hair_mirrored_rise.y, 0.0, 1.0);
  tilt = vec3(dot(strand, h), dot(n, h), look_hair_mirrored_part * shadow * lit);
}
