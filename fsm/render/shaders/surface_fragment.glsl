// kRelief precedes this text: whether fine slopes and creases are visible.
in vec2 detail_uv;
in vec3 light;
in vec4 slopes;
in vec3 shine;
flat in vec4 finish;
flat in vec4 gleam;

uniform sampler2D tint;   // factors on colour in rgb, on highlights in a; 0.5 stands for 1
uniform sampler2D relief; // slopes to the right and up: fine detail in rg, creases in ba

out vec4 colour;

void main() {
  vec4 t = texture(tint, detail_uv);
  vec2 slope = vec2(0.0);
  if (kRelief) {
    vec4 r = texture(relief, detail_uv) - 0.5;
    slope = r.xy * finish.w + r.zw * shine.y;
  }
  // Highlights decrease with the distance of the half vector from the normal, both as slopes; the lobes are powers
  // 20, 64 and 144 of its cosine, as products (pow costs as much as a lamp in software).
  vec2 h = slopes.zw + slope;
  float d = dot(h, h);
  vec3 lobe = max(1.0 - d * vec3(2.5, 8.0, 18.0), 0.0);
  lobe *= lobe;
  lobe *= lobe;
  float highlight = shine.x * t.a * dot(lobe, finish.xyz) + shine.z;
  vec3 seen = ToScreen(t.rgb * (light * (2.0 + 2.0 * dot(slope, slopes.xy))) +
                       gleam.rgb * highlight);
  colour = vec4(mix(vec3(dot(seen, vec3(0.3, 0.6, 0.1))), seen, gleam.a), 1.0);
}
