// Parts of heads from elsewhere that say themselves how they take light.
layout(location = 7) in vec3 photo_place;  // u, v down; z > 0: the colour is there

out vec3 at;
out vec3 facing;
out vec3 worn;
out vec3 tint;

void main() {
  at = Place();
  facing = WorldNormal();
  worn = photo_place;
  tint = albedo_occlusion.rgb;
}
