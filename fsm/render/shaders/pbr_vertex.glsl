// Parts of heads from files that bring their own materials.
layout(location = kTexcoord) in vec3 photo_texcoord;  // u, v down; z > 0: the picture has the colour

out vec3 at;
out vec3 facing;
out vec3 texcoord;
out vec3 tint;

void main() {
  at = TransformVertex();
  facing = WorldNormal();
  texcoord = photo_texcoord;
  tint = albedo_openness.rgb;
}
