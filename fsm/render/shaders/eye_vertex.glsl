// Eyeballs, which are shaded per pixel, and lines, which are not shaded at all.
out vec3 world_position;
out vec3 albedo;
out float occlusion;

void main() {
  world_position = Place();
  albedo = albedo_occlusion.rgb;
  occlusion = albedo_occlusion.a;
}
