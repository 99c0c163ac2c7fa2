in vec2 streak_uv;
in vec2 fray;
in vec3 light;
in vec3 key_light;
in vec3 tilt;
flat in vec4 gleam;

uniform sampler2D strands;  // locks in b, hairs in a

out vec4 colour;

void main() {
  vec4 fine = texture(strands, streak_uv) - 0.5;
  // Where hair thins out, some hairs are missing and others remain.
  float density = look_hair_closed * fray.x * min(2.2 - 2.2 * abs(fray.y), 1.0);
  // Ends and edges thin out softly, because each sample of a pixel compares with another density.
  vec2 odd = mod(floor(gl_FragCoord.xy), 2.0);
  float asks = 0.35 * (0.5 * odd.x + 0.25 * odd.y - odd.x * odd.y);
  if (density < 0.5 - fine.a + asks) discard;
  float streak = (look_hair_differs * fine.a + look_lock_differs * fine.b) * gleam.a;
  // Highlights run across the strands. There are two, shifted along the strand: light reflected by the surface,
  // shifted to the root, and light that passed through and took its colour, shifted to the tip.
  float a = tilt.x + tilt.y * (look_hair_mirrored_shift + 0.25 * streak);
  float b = tilt.x - tilt.y * (look_hair_through_shift - 0.25 * streak);
  vec2 lobe = max(1.0 - vec2(a * a * look_hair_mirrored_narrow, b * b * look_hair_through_narrow), 0.0);
  lobe *= lobe;
  lobe *= lobe;
  lobe.x *= lobe.x;
  vec3 seen = light * (1.0 + look_streaks_seen * streak) +
              key_light * lobe.y + gleam.rgb * (tilt.z * lobe.x);
  // A lock is round: its sides get less light.
  seen *= 1.0 - look_lock_sides * gleam.a * fray.y * fray.y;
  colour = vec4(ToScreen(max(seen, 0.0)), 1.0);
}
