// Eyeballs, which are shaded per pixel, and lines, which are not shaded at all.
out vec3 world_position;
out float openness;

void main() {
  world_position = TransformVertex();
  openness = albedo_openness.a;
}
