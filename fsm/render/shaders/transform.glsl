// The head's vertices and their positions, shared by all vertex shaders: depth is compared for equality between
// passes, so every program must transform a vertex in the same way.
layout(location = kPosition) in vec3 position;
layout(location = kNormal) in vec3 normal;
layout(location = kRestPosition) in vec3 rest_position;
layout(location = kAlbedoOpenness) in vec4 albedo_openness;

uniform mat4 figure_to_world;
uniform mat4 world_to_clip;

invariant gl_Position;

// Sets gl_Position and returns the position in the world.
vec3 TransformVertex() {
  vec4 world = figure_to_world * vec4(position, 1.0);
  gl_Position = world_to_clip * world;
  return world.xyz;
}

// The figure is only rotated, moved and scaled uniformly, so normals need no matrix of their own.
vec3 WorldNormal() { return normalize(mat3(figure_to_world) * normal); }
