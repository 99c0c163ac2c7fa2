in vec3 world_normal;
in vec3 half_way;
in vec3 strand;
in vec3 streak_place;
in vec3 soft_light;
in vec3 key_light;
in vec3 tint;

uniform float alpha;
uniform float streaks;     // how strongly strands differ, 0 for lashes
uniform float shine;
uniform sampler3D noise;

out vec4 color;

void main() {
  vec4 thick = texture(noise, streak_place) - 0.5;
  float streak = (thick.a + 1.2 * thick.r) * streaks;
  // Highlights lie across the strands. Two of them, shifted along the strand: light mirrored by the
  // surface towards the root, light that went through and took its colour towards the tip.
  vec3 n = world_normal;
  vec3 h = normalize(half_way);
  float t_dot_h = dot(normalize(strand), h);
  float n_dot_h = dot(n, h) / max(length(n), 1e-3);
  float a = t_dot_h + n_dot_h * (0.12 + 0.25 * streak);
  float b = t_dot_h - n_dot_h * (0.18 - 0.25 * streak);
  float a4 = max(1.0 - a * a, 0.0);
  float b4 = max(1.0 - b * b, 0.0);
  a4 *= a4;
  a4 *= a4;
  b4 *= b4;
  b4 *= b4;
  float a16 = a4 * a4 * a4 * a4;
  vec3 light = (soft_light + key_light) * (1.0 + 0.9 * streak);
  light += shine * (key_light * 0.9 * (b4 * b4 * b4 * b4) + tint * (0.035 * a16 * a16 * a16));
  color = vec4(ToScreen(max(light, 0.0)), alpha);
}
