// Hair, brows and lashes. Strands fall in planes through a vertical axis under the crown.
uniform vec3 crown;          // at rest
uniform mat3 rest_to_world;  // how the head is turned

out vec3 world_normal;
out vec3 half_way;     // between the key light and the viewer
out vec3 strand;       // along the hair
out vec3 streak_place;
out vec3 soft_light;
out vec3 key_light;
out vec3 tint;         // of light that went through the hair

void main() {
  vec3 world = Place();
  vec3 n = WorldNormal();
  vec3 v = normalize(eye - world);
  // Sheets are seen from both sides.
  if (dot(n, v) < 0.0) n = -n;
  vec3 albedo = albedo_occlusion.rgb;
  float occlusion = albedo_occlusion.a;

  vec3 from_crown = rest_position - crown;
  vec2 around = from_crown.xz / (length(from_crown.xz) + 1e-3);
  vec3 side = rest_to_world * vec3(-around.y, 0.0, around.x);
  strand = cross(n, side);
  streak_place = vec3(around * 1.3, length(from_crown) * 0.0016);

  // Light falls on a strand by the sine of its angle to it (Kajiya and Kay 1989).
  float shadow = mix(occlusion, 1.0, 0.25) * mix(KeyShadow(world), 1.0, 0.3);
  float t_dot_l = dot(normalize(strand + n * 1e-4), key_direction);
  float across = 0.4 + 0.6 * sqrt(max(1.0 - t_dot_l * t_dot_l, 0.0));
  soft_light = albedo * occlusion *
               (Ambient(n) + kFillColor * max((dot(n, kFillDirection) + 0.35) / 1.82, 0.0));
  float rim = clamp(dot(n, kRimDirection) * 0.8 + 0.3, 0.0, 1.0);
  float away = 1.0 - max(dot(n, v), 0.0);
  soft_light += kRimColor * occlusion * rim * (albedo * 0.7 + 0.10 * away * away);
  key_light = kKeyColor * shadow * albedo * max((dot(n, key_direction) + 0.35) / 1.82, 0.0) * across;
  tint = kKeyColor * shadow * clamp(dot(n, key_direction) * 1.7 + 0.3, 0.0, 1.0);
  half_way = normalize(key_direction + v);
  world_normal = n;
}
