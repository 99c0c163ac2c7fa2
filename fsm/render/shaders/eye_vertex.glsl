// Vertices of eyeballs, which are shaded per pixel, and of lines, which are not shaded.
out vec3 world_position;
out float openness;

void main() {
  world_position = TransformVertex();
  openness = albedo_openness.a;
}
