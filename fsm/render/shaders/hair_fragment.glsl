in vec2 streak_place;
in vec2 fray;
in vec3 light;
in vec3 key_light;
in vec3 tilt;

uniform float alpha;
uniform float streaks;   // how strongly strands differ, 0 for lashes
uniform float shine;
uniform sampler2D strands;  // locks in b, hairs in a

out vec4 color;

void main() {
  vec4 fine = texture(strands, streak_place) - 0.5;
  // Where hair thins out some hairs are gone and some are left.
  float cover = fray.x * min(2.2 - 2.2 * abs(fray.y), 1.0);
  if (cover < 0.5 - fine.a) discard;
  float streak = (0.8 * fine.a + 1.1 * fine.b) * streaks;
  // Highlights lie across the strands. Two of them, shifted along the strand: light mirrored by the
  // surface towards the root, light that went through and took its colour towards the tip.
  float a = tilt.x + tilt.y * (0.12 + 0.25 * streak);
  float b = tilt.x - tilt.y * (0.18 - 0.25 * streak);
  vec2 lobe = max(1.0 - vec2(a * a * 6.0, b * b * 2.2), 0.0);
  lobe *= lobe;
  lobe *= lobe;
  lobe.x *= lobe.x;
  vec3 seen = light * (1.0 + 0.9 * streak) +
              shine * (key_light * (0.9 * lobe.y) + lamp_colors[0] * (tilt.z * lobe.x));
  color = vec4(ToScreen(max(seen, 0.0)), alpha);
}
