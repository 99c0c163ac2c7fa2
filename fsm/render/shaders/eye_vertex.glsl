// Eyeballs, which are shaded per pixel, and lines, which are not shaded at all.
out vec3 world_position;
out float occlusion;

void main() {
  world_position = TransformVertex();
  occlusion = albedo_occlusion.a;
}
