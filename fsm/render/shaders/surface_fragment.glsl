in vec3 world_normal;
in vec3 half_way;
in vec3 rest;
in vec3 soft_light;
in vec3 key_light;
in float gloss;

uniform float alpha;
uniform vec3 wrap;
uniform float bump;   // of pores or threads, on the normal
uniform float grain;  // and on the colour
uniform vec3 lobes;   // strengths of a broad, a middle and a tight highlight
// Tileable noise of 32 cells: gradient in rgb, value in a, both about 0.5.
uniform sampler3D noise;

out vec4 color;

void main() {
  vec3 n = normalize(world_normal);
  // In the head's own coordinates, so that it moves with the skin.
  vec4 fine = texture(noise, rest * 0.045) - 0.5;
  vec3 rough = normalize(n - (fine.rgb - n * dot(fine.rgb, n)) * bump);
  vec3 light = soft_light + key_light * Wrapped(dot((n + rough) * 0.5, key_direction), wrap);
  // Powers 20, 64 and 144 as products: in software the pow function costs as much as a lamp.
  float h = max(dot(rough, normalize(half_way)), 0.0);
  float h4 = h * h * h * h;
  float h16 = h4 * h4 * h4 * h4;
  float h64 = h16 * h16 * h16 * h16;
  float highlight = gloss * dot(lobes, vec3(h16 * h4, h64, h64 * h64 * h16));
  color = vec4(ToScreen(light * (1.0 + grain * fine.a) + kKeyColor * highlight), alpha);
}
