// Eyeballs: white, iris and pupil are all found per pixel, so that they are round whatever the mesh.
// Everything is seen through a wet surface whose highlight comes from a sphere of its own.
in vec3 world_position;
in float occlusion;

uniform sampler2D noise;
uniform vec4 ball[2];    // centre in world coordinates, radius; left of the picture, right
uniform vec3 gaze[2];    // unit, from the ball's centre through the pupil
uniform vec4 lids[2];    // world y of the upper and the lower rim at the pupil, unused
uniform vec4 iris;       // radius, pupil's part of it, how far its plane lies before the centre, 0
uniform vec3 iris_color;
uniform vec3 white_color;
uniform float figure_scale;
uniform float flesh_red;         // 0: flesh and vessels are grey, as in a grey photo
uniform float photo_brightness;  // beside a photo, whose colours are shown as they are; else 0
uniform float iris_span;         // a photo of the eyes: its picture of the iris reaches so many radii; else 0
uniform vec4 irises[2];          // left, top, right, bottom in the photo
uniform vec4 balls[2];
uniform vec4 open[2];        // heights of the lids over the centre: upper and lower at rest, upper now;
                             // how far the picture of the ball reaches
uniform mat3 world_to_head;  // to millimetres
uniform sampler2D photo;

out vec4 color;

const float kCorner = 1.1;  // how far the corners of the eye are beside its middle, in radii of the ball

// The iris at a place of its plane, in units of its radius: fibres run from the pupil to the rim,
// which is dark (the limbal ring).
vec3 Iris(vec2 p, float r, float toward_light) {
  float turn = atan(p.y, p.x) / 6.2831853;
  float fibre = textureLod(noise, vec2(turn * 0.25, r * 0.010), 0.0).b * 0.6 +
                textureLod(noise, vec2(turn * 0.75, r * 0.024 + 0.4), 0.0).a * 0.5;
  vec3 base = iris_color * (iris_between + iris_fibre * fibre);
  float collar = smoothstep(0.66, 0.40, r + 0.12 * (fibre - 0.5));
  base = mix(base, base * iris_collar + 0.008, collar * iris_collar_part);
  // Light falls in through the cornea and gathers on the far side.
  base *= 0.85 + iris_gathered * max(-toward_light, 0.0) * smoothstep(0.3, 0.9, r);
  base *= mix(1.0, photo_brightness > 0.0 ? photo_iris_rim : iris_rim, smoothstep(0.78, 1.0, r));
  return mix(vec3(pupil_color), base, smoothstep(iris.y - 0.05, iris.y + 0.04, r + 0.03 * (fibre - 0.5)));
}

vec3 Photographed(vec4 square, vec2 from_middle) {
  vec2 part = clamp(0.5 + 0.5 * vec2(from_middle.x, -from_middle.y), 0.0, 1.0);
  return ToLinear(texture(photo, mix(square.xy, square.zw, part)).rgb);
}

void main() {
  int side = distance(world_position, ball[0].xyz) < distance(world_position, ball[1].xyz) ? 0 : 1;
  vec3 centre = ball[side].xyz;
  float radius = ball[side].w;
  vec3 axis = gaze[side];
  vec3 from_centre = world_position - centre;
  vec3 v = normalize(eye - world_position);
  vec3 n = normalize(from_centre);

  // The cornea: a smaller sphere standing out of the ball; the white keeps the ball's own normal.
  float r_surface = length(from_centre - axis * dot(from_centre, axis)) / iris.x;
  vec3 cornea = normalize(world_position - (centre + axis * radius * 0.46));
  vec3 wet = normalize(mix(cornea, n, smoothstep(0.95, 1.25, r_surface)));

  vec3 across_right = normalize(cross(vec3(0.0, 1.0, 0.0), axis) + vec3(1e-5, 0.0, 0.0));
  vec3 across_up = cross(axis, across_right);
  // Reddish towards the corners, shaded at the edge of the iris, with a few fine vessels.
  float corner = smoothstep(0.30, 1.0, abs(n.x - axis.x));
  float red = flesh_red;
  vec3 base = white_color * mix(vec3(1.0), mix(vec3(white_corner_grey), white_corner, red), corner);
  base *= mix(white_at_iris, 1.0, smoothstep(1.0, 1.18, r_surface));
  // The flesh of the tear corner.
  float inward = side == 0 ? n.x - axis.x : axis.x - n.x;
  base = mix(base, white_color * mix(vec3(tear_flesh_grey), tear_flesh, red), 0.85 * smoothstep(0.66, 0.80, inward));
  float vessel = texture(noise, vec2(n.y * 0.11, n.x * 0.025) + axis.xy * 0.01).b - 0.5;
  base *= 1.0 - red * vec3(0.0, vessel_redness, vessel_redness) * smoothstep(0.10, 0.26, vessel) * smoothstep(1.3, 2.0, r_surface);
  bool shown = iris_span > 0.0;
  if (shown) {
    // The shade of the lid goes with it where the eye opens wider.
    vec4 lid = open[side];
    vec2 q = (world_to_head * from_centre).xy;
    q.y = lid.y + (q.y - lid.y) * min((lid.x - lid.y) / max(lid.z - lid.y, 0.1), 1.0);
    base = Photographed(balls[side], q / lid.w);
  }
  // A photo shows the soft edge of the iris, too.
  float edge = shown ? smoothstep(1.20, 1.02, r_surface) : smoothstep(1.06, 0.98, r_surface);
  if (edge > 0.0) {
    // The line of sight bends at the cornea and meets the plane of the iris behind it.
    vec3 ray = refract(-v, wet, 1.0 / 1.336);
    float depth = dot(from_centre, axis) - iris.z;
    vec3 hit = from_centre + ray * (max(depth, 0.0) / max(-dot(ray, axis), 0.2));
    vec2 p = vec2(dot(hit, across_right), dot(hit, across_up)) / iris.x;
    float r = length(p);
    vec3 l = lamp_directions[0];
    vec3 inner = Iris(p, r, dot(p / max(r, 1e-3), vec2(dot(l, across_right), dot(l, across_up))));
    if (shown) {
      inner = Photographed(irises[side], p / iris_span);
    } else {
      // Where the line of sight misses the iris it meets the white beside it, in the rim's shadow.
      inner = mix(inner, white_color * 0.3, smoothstep(1.0, 1.12, r));
    }
    base = mix(base, inner, edge);
  }

  // The upper lid and its lashes shade the ball below them. Its rim falls and the lower one rises to the corners.
  float below_lid = (lids[side].x - world_position.y) / figure_scale;
  float above_lower = (world_position.y - lids[side].y) / figure_scale;
  float beside = dot(from_centre, across_right) / (radius * kCorner);
  float narrower = beside * beside * (lids[side].x - lids[side].y) / figure_scale;
  float shade = mix(upper_lid_shade, 1.0, smoothstep(-0.5, lid_shade_reach, below_lid - 0.55 * narrower)) *
                mix(lower_lid_shade, 1.0, smoothstep(-0.5, 1.2, above_lower - 0.3 * narrower));

  shade = photo_brightness > 0.0 ? 0.1 + 0.9 * shade : shade;
  if (shown) {
    // The photo has its shade, but not where it was completed and where the eye opens wider than in it.
    vec2 q = (world_to_head * from_centre).xy;
    float aside = q.x / (radius * kCorner / figure_scale);
    float rim = open[side].z - aside * aside * 0.65 * (open[side].z - open[side].y);
    shade = mix(mix(0.72, 0.5, edge), 1.0, smoothstep(-0.4, 1.7, rim - q.y)) *
            mix(0.8, 1.0, smoothstep(-0.3, 0.7, above_lower));
    // A lower lid that squints brings its lashes and its shade along, most in the middle.
    float raised = (lids[side].y - centre.y) / figure_scale - open[side].y;
    shade *= 1.0 - 0.45 * smoothstep(0.3, 1.6, raised) *
                       smoothstep(2.0 - 0.7 * aside * aside, 0.4, above_lower);
    // Its wet rim is soft and pale.
    vec3 rim_color = white_color * mix(vec3(0.5), vec3(0.66, 0.42, 0.36), red);
    base = mix(base, rim_color / max(shade, 0.3), 0.75 * smoothstep(0.15, 0.8, raised) * smoothstep(0.75, 0.1, above_lower));
  }

  vec3 light = Ambient(n) * 0.9;
  light += lamp_colors[0] * Wrapped(dot(n, lamp_directions[0]), vec3(0.35)) * 0.8;
  light += lamp_colors[1] * Wrapped(dot(n, lamp_directions[1]), vec3(0.35));
  light = photo_brightness > 0.0 ? vec3(1.0) : light;
  vec3 result = base * light * shade * mix(occlusion, 1.0, 0.3);

  // What a photographed eye mirrors is seen in it.
  // One drawn into a photo mirrors as little light as there is.
  float bright = clamp(dot(white_color, vec3(0.3, 0.5, 0.2)) / 0.4, 0.15, 1.0);
  float gloss = photo_brightness > 0.0 ? (shown ? 0.0 : photo_gloss * bright) : 1.0;
  vec3 mirrored = reflect(-v, wet);
  // A window of two panes, above left.
  const vec3 kWindow = vec3(-0.4212, 0.5215, 0.7421);
  const vec3 kAcross = vec3(0.8697, 0.0, 0.4936);
  vec2 pane = vec2(dot(mirrored, kAcross), dot(mirrored, cross(kWindow, kAcross)));
  vec2 inside = smoothstep(vec2(0.27, 0.31), vec2(0.16, 0.20), abs(pane));
  float window = inside.x * inside.y * step(0.0, dot(mirrored, kWindow)) *
                 mix(mirrored_bar, 1.0, smoothstep(0.01, 0.04, abs(pane.x + 0.02)));
  // A photographer's lamp is smaller and round.
  if (photo_brightness > 0.0) window = photo_lamp * smoothstep(0.24, 0.04, length(pane)) * step(0.0, dot(mirrored, kWindow));
  float soft_box = pow(max(dot(mirrored, lamp_directions[1]), 0.0), 24.0);
  result += gloss * mirrored_window * lamp_colors[0] * window * mix(1.0, window_on_white, smoothstep(1.0, 1.3, r_surface)) * sqrt(shade);
  result += gloss * lamp_colors[1] * mirrored_box * soft_box * shade;
  // Tears stand along the lower lid and catch the light from above.
  float tears = smoothstep(0.9, 0.35, above_lower - 0.3 * narrower) * smoothstep(0.9, 0.3, abs(beside));
  result += gloss * mirrored_tears * tears * light;
  result += gloss * Ambient(mirrored) * Fresnel(dot(wet, v)) * shade * mirrored_room;
  result = max(result, 0.0);
  color = vec4(photo_brightness > 0.0 ? photo_brightness * pow(result, vec3(0.4545)) : ToScreen(result), 1.0);
}
