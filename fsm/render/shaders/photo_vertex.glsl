// What wears a photo: skin, lips, and the sheet of hair, neck and clothes.
layout(location = 4) in vec2 unrolled;
layout(location = 5) in vec4 creases_right;
layout(location = 6) in vec4 creases_left;
layout(location = 7) in vec3 photo_place;  // u, v down; the photo's part in the colour

uniform vec4 crease_depths[2];

out vec2 place;
out vec3 worn;
out vec3 paint;
out float crease;

void main() {
  Place();
  place = unrolled;
  worn = photo_place;
  crease = dot(creases_right, crease_depths[0]) + dot(creases_left, crease_depths[1]);
  paint = sqrt(max(albedo_occlusion.rgb * albedo_occlusion.a, 0.0));
}
