// Eyeballs: `layer` 0 = white, 1 = iris, 2 = pupil. Everything is seen through a wet cornea whose
// highlight is drawn here, from a sphere of its own, so that it is round whatever the mesh.
in vec3 world_position;
in vec3 albedo;
in float occlusion;

uniform float alpha;
uniform sampler3D noise;
uniform float layer;
uniform vec4 ball[2];    // centre in world coordinates, radius; left of the picture, right
uniform vec3 gaze[2];    // unit, from the ball's centre through the pupil
uniform vec4 lids[2];    // world y of the upper and the lower rim at the pupil, lid width, unused
uniform float iris_radius;
uniform float figure_scale;

out vec4 color;

void main() {
  int side = distance(world_position, ball[0].xyz) < distance(world_position, ball[1].xyz) ? 0 : 1;
  vec3 centre = ball[side].xyz;
  float radius = ball[side].w;
  vec3 axis = gaze[side];
  vec3 from_centre = world_position - centre;
  vec3 v = normalize(eye - world_position);
  vec3 n = normalize(from_centre);

  vec3 across = from_centre - axis * dot(from_centre, axis);
  float r = length(across) / iris_radius;

  vec3 base = albedo;
  if (layer > 0.5) {
    // Fibres run from the pupil to the rim, which is dark; light falls in from above and comes out
    // below, brightening the far half of the iris.
    vec3 spoke = normalize(across + vec3(1e-4));
    float fibre = texture(noise, vec3(spoke.xy * 0.55, r * 0.04)).a +
                  0.6 * texture(noise, vec3(spoke.xy * 1.3, r * 0.05 + 0.5)).a;
    float inner = smoothstep(0.62, 0.3, r);
    base = albedo * (0.45 + 0.75 * fibre);
    base = mix(base, base * vec3(1.45, 1.15, 0.75), inner * 0.6);
    base *= 1.0 + 0.5 * dot(spoke, -key_direction) * smoothstep(0.3, 0.8, r);
    base *= mix(1.0, 0.22, smoothstep(0.80, 1.0, r));
    base *= mix(1.0, 0.02, smoothstep(0.40, 0.36, r));
    if (layer > 1.5) base = vec3(0.004);
  } else {
    // Reddish towards the corners, shaded at the edge of the iris.
    float corner = smoothstep(0.25, 0.95, abs(n.x - axis.x));
    base *= mix(vec3(1.0), vec3(0.92, 0.70, 0.64), corner);
    base *= mix(0.35, 1.0, smoothstep(0.96, 1.18, r));
  }

  // The upper lid and its lashes shade the ball below them.
  float below_lid = (lids[side].x - world_position.y) / figure_scale;
  float above_lower = (world_position.y - lids[side].y) / figure_scale;
  float shade = mix(0.30, 1.0, smoothstep(-0.5, 3.4, below_lid)) *
                mix(0.62, 1.0, smoothstep(-0.5, 1.6, above_lower));

  vec3 light = Ambient(n) * 0.9;
  light += kKeyColor * Wrapped(dot(n, key_direction), vec3(0.35)) * 0.8;
  light += kFillColor * Wrapped(dot(n, kFillDirection), vec3(0.35));
  vec3 result = base * light * shade * mix(occlusion, 1.0, 0.3);

  // The cornea: a smaller sphere standing out of the ball; the white keeps the ball's own normal.
  vec3 cornea_centre = centre + axis * radius * 0.46;
  vec3 cornea = normalize(world_position - cornea_centre);
  vec3 wet = normalize(mix(cornea, n, smoothstep(0.95, 1.25, r)));
  vec3 mirrored = reflect(-v, wet);
  float window = smoothstep(0.945, 0.972, dot(mirrored, normalize(vec3(-0.42, 0.52, 0.74))));
  float soft_box = pow(max(dot(mirrored, kFillDirection), 0.0), 24.0);
  result += vec3(2.6) * window * mix(1.0, 0.35, smoothstep(1.0, 1.3, r)) * sqrt(shade);
  result += kFillColor * 0.16 * soft_box * shade;
  result += Ambient(mirrored) * Fresnel(dot(wet, v)) * shade * 0.6;
  color = vec4(ToScreen(max(result, 0.0)), alpha);
}
