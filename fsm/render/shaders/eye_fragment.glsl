// Eyeballs: sclera, iris and pupil are computed per pixel, so that they are round whatever the mesh. They are seen
// through a wet surface whose highlight comes from a sphere of its own, the cornea.
in vec3 world_position;
in float openness;

uniform sampler2D noise;
uniform vec4 ball[2];         // centre in world coordinates, radius; index 0: left in the picture
uniform vec3 gaze[2];         // unit vector from the ball's centre through the pupil
uniform vec4 lid_heights[2];  // world y of upper and lower lid margin at the pupil; z, w unused
uniform float iris_radius;
uniform float pupil_share;    // pupil's radius as a fraction of the iris's
uniform float iris_depth;     // distance of the plane of the iris before the centre
uniform vec3 iris_colour[2];
uniform vec3 white_colour[2];
uniform float figure_scale;
uniform float flesh_red;         // 0: caruncle and vessels are grey, as in a grey photo
uniform bool beside_photo;       // the face wears a photo, whose colours are shown unlit
uniform float lamp_brightness;  // factor on that photo
uniform bool pictured;           // the photo shows the eyes; only then the following apply:
uniform float iris_span;            // radii of the iris that its picture reaches
uniform vec4 photo_iris_rect[2];    // left, top, right, bottom in the photo
uniform vec4 photo_ball_rect[2];
uniform vec4 photo_lid_heights[2];  // relative to the centre: upper and lower margin at rest, upper margin now; how
                                    // far the picture of the ball reaches
uniform mat3 world_to_head;         // to millimetres
uniform sampler2D base_colour;

out vec4 colour;

const float kCorner = 1.1;  // distance of the eye's corners from its middle, in radii of the ball

// The point of an eyeball that a pixel shows.
struct EyePoint {
  int side;
  float radius;       // of the ball
  vec3 axis;          // direction of the gaze
  vec3 from_centre;
  vec3 to_viewer;
  vec3 normal;        // of the ball
  vec3 wet;           // normal of the wet surface
  vec3 right, up;     // perpendicular to `axis`
  float from_axis;    // in radii of the iris
  float below_upper;  // millimetres from the lid margins
  float above_lower;
  float beside;       // -1..1 from corner to corner
  float narrower;     // millimetres by which the lids are closer together than in the middle
};

EyePoint FindEyePoint() {
  EyePoint p;
  p.side = distance(world_position, ball[0].xyz) < distance(world_position, ball[1].xyz) ? 0 : 1;
  vec3 centre = ball[p.side].xyz;
  p.radius = ball[p.side].w;
  p.axis = gaze[p.side];
  p.from_centre = world_position - centre;
  p.to_viewer = normalize(eye - world_position);
  p.normal = normalize(p.from_centre);
  // The cornea is a smaller sphere that protrudes from the ball; the sclera keeps the ball's normal.
  p.from_axis = length(p.from_centre - p.axis * dot(p.from_centre, p.axis)) / iris_radius;
  vec3 cornea = normalize(world_position - (centre + p.axis * p.radius * look_cornea_centre));
  p.wet = normalize(mix(cornea, p.normal, Ramp(look_cornea_edge, p.from_axis)));
  p.right = normalize(cross(vec3(0.0, 1.0, 0.0), p.axis) + vec3(1e-5, 0.0, 0.0));
  p.up = cross(p.axis, p.right);
  vec2 lids = lid_heights[p.side].xy;
  p.below_upper = (lids.x - world_position.y) / figure_scale;
  p.above_lower = (world_position.y - lids.y) / figure_scale;
  p.beside = dot(p.from_centre, p.right) / (p.radius * kCorner);
  p.narrower = p.beside * p.beside * (lids.x - lids.y) / figure_scale;
  return p;
}

// Returns the iris's colour at a point of its plane, in units of its radius: fibres run from the pupil to the rim,
// which is dark (the limbal ring).
vec3 Iris(int side, vec2 p, float r, float toward_light) {
  float azimuth = atan(p.y, p.x) / 6.2831853;
  float fibre = textureLod(noise, vec2(azimuth * 0.25, r * 0.010), 0.0).b * 0.6 +
                textureLod(noise, vec2(azimuth * 0.75, r * 0.024 + 0.4), 0.0).a * 0.5;
  vec3 base = iris_colour[side] * (look_iris_between + look_iris_fibre * fibre);
  float collar = Ramp(look_iris_collar_edge, r + look_iris_collar_ragged * (fibre - 0.5));
  base = mix(base, base * look_iris_collar + look_iris_collar_least, collar * look_iris_collar_part);
  // Light enters through the cornea and gathers on the far side.
  base *= look_iris_light + look_iris_gathered * max(-toward_light, 0.0) * Ramp(look_iris_gathered_edge, r);
  base *= mix(1.0, beside_photo ? look_photo_iris_rim : look_iris_rim, Ramp(look_iris_rim_edge, r));
  float ragged = r + look_pupil_ragged * (fibre - 0.5);
  return mix(vec3(look_pupil_colour), base, Ramp(pupil_share + look_pupil_edge, ragged));
}

vec3 Photographed(vec4 rect, vec2 from_middle) {
  vec2 part = clamp(0.5 + 0.5 * vec2(from_middle.x, -from_middle.y), 0.0, 1.0);
  return ToLinear(texture(base_colour, mix(rect.xy, rect.zw, part)).rgb);
}

// Returns the sclera in the photo. The lid's shadow is stretched with it where the eye opens wider.
vec3 PhotographedWhite(EyePoint p) {
  vec4 lid = photo_lid_heights[p.side];
  vec2 q = (world_to_head * p.from_centre).xy;
  q.y = lid.y + (q.y - lid.y) * min((lid.x - lid.y) / max(lid.z - lid.y, 0.1), 1.0);
  return Photographed(photo_ball_rect[p.side], q / lid.w);
}

// Returns the painted sclera: reddish towards the corners, darker at the limbus, with a few fine vessels.
vec3 White(EyePoint p) {
  float corner = Ramp(look_white_corner_edge, abs(p.normal.x - p.axis.x));
  vec3 at_corner = mix(vec3(look_white_corner_grey), look_white_corner, flesh_red);
  vec3 white = white_colour[p.side] * mix(vec3(1.0), at_corner, corner);
  white *= mix(look_white_at_iris, 1.0, Ramp(look_white_at_iris_edge, p.from_axis));
  // The caruncle, in the inner corner.
  float inward = p.side == 0 ? p.normal.x - p.axis.x : p.axis.x - p.normal.x;
  white = mix(white, white_colour[p.side] * mix(vec3(look_tear_flesh_grey), look_tear_flesh, flesh_red),
              look_tear_flesh_part * Ramp(look_tear_flesh_edge, inward));
  float vessel = texture(noise, vec2(p.normal.y * 0.11, p.normal.x * 0.025) + p.axis.xy * 0.01).b - 0.5;
  return white * (1.0 - flesh_red * vec3(0.0, look_vessel_redness, look_vessel_redness) *
                            Ramp(look_vessel_edge, vessel) *
                            Ramp(look_vessels_from_iris, p.from_axis));
}

// The line of sight is refracted at the cornea and meets the plane of the iris behind it.
vec3 IrisSeen(EyePoint p) {
  vec3 ray = refract(-p.to_viewer, p.wet, 1.0 / 1.336);
  float depth = dot(p.from_centre, p.axis) - iris_depth;
  vec3 hit = p.from_centre + ray * (max(depth, 0.0) / max(-dot(ray, p.axis), 0.2));
  vec2 at = vec2(dot(hit, p.right), dot(hit, p.up)) / iris_radius;
  if (pictured) return Photographed(photo_iris_rect[p.side], at / iris_span);
  float r = length(at);
  vec3 l = lamp_directions[0];
  vec3 iris = Iris(p.side, at, r, dot(at / max(r, 1e-3), vec2(dot(l, p.right), dot(l, p.up))));
  // Where the line of sight misses the iris it meets the sclera beside it, in the rim's shadow.
  return mix(iris, white_colour[p.side] * look_white_past_iris, Ramp(look_white_past_iris_edge, r));
}

// The upper lid and its lashes shade the ball. Towards the corners its margin falls and the lower one rises.
float LidShade(EyePoint p) {
  float below = p.below_upper - look_upper_lid_falls * p.narrower;
  float above = p.above_lower - look_lower_lid_rises * p.narrower;
  float shade = mix(look_upper_lid_shade, 1.0, Ramp(look_upper_lid_edge, below)) *
                mix(look_lower_lid_shade, 1.0, Ramp(look_lower_lid_edge, above));
  return beside_photo ? look_photo_lid_least + (1.0 - look_photo_lid_least) * shade : shade;
}

// The photo includes the lids' shade, except where it was completed and where the eye opens wider than in it. `edge`:
// how much of `base`, the colour, is iris.
float PhotoShade(EyePoint p, float edge, inout vec3 base) {
  vec4 lid = photo_lid_heights[p.side];
  vec2 q = (world_to_head * p.from_centre).xy;
  float aside = q.x / (p.radius * kCorner / figure_scale);
  float rim = lid.z - aside * aside * look_photo_lid_falls * (lid.z - lid.y);
  float shade = mix(mix(look_photo_lid_on_white, look_photo_lid_on_iris, edge), 1.0,
                    Ramp(look_photo_upper_lid_edge, rim - q.y)) *
                mix(look_photo_lower_lid, 1.0, Ramp(look_photo_lower_lid_edge, p.above_lower));
  // A squinting lower lid carries its lashes and its shade along, most in the middle.
  float raised = (lid_heights[p.side].y - ball[p.side].y) / figure_scale - lid.y;
  shade *= 1.0 - look_photo_squint * Ramp(look_photo_squint_raised, raised) *
                     smoothstep(look_photo_squint_edge.x - look_photo_squint_aside * aside * aside,
                                look_photo_squint_edge.y, p.above_lower);
  // Its wet margin is soft and pale.
  vec3 rim_colour = white_colour[p.side] * mix(vec3(look_photo_wet_rim_grey), look_photo_wet_rim, flesh_red);
  base = mix(base, rim_colour / max(shade, 0.3),
             look_photo_wet_rim_part * Ramp(look_photo_wet_rim_raised, raised) *
                 Ramp(look_photo_wet_rim_edge, p.above_lower));
  return shade;
}

// Adds the reflections of the wet surface. `light`: light on the ball.
void AddMirrored(EyePoint p, float shade, vec3 light, inout vec3 seen) {
  // A photographed eye already shows its reflections; an eye drawn into a photo reflects in proportion to the light
  // there is.
  float bright = clamp(dot(white_colour[p.side], vec3(0.3, 0.5, 0.2)) / 0.4, 0.15, 1.0);
  float gloss = beside_photo ? (pictured ? 0.0 : look_photo_gloss * bright) : 1.0;
  vec3 mirrored = reflect(-p.to_viewer, p.wet);
  vec2 pane = vec2(dot(mirrored, look_window_across), dot(mirrored, cross(look_window_at, look_window_across)));
  vec2 inside = smoothstep(look_window_outer, look_window_inner, abs(pane));
  float window = inside.x * inside.y * step(0.0, dot(mirrored, look_window_at)) *
                 mix(look_mirrored_bar, 1.0, Ramp(look_window_bar_edge, abs(pane.x - look_window_bar_at)));
  if (beside_photo) {
    window = look_photo_lamp * Ramp(look_photo_lamp_edge, length(pane)) * step(0.0, dot(mirrored, look_window_at));
  }
  float soft_box = pow(max(dot(mirrored, lamp_directions[1]), 0.0), look_mirrored_box_narrow);
  seen += gloss * look_mirrored_window * lamp_colours[0] * window *
          mix(1.0, look_window_on_white, Ramp(look_window_white_edge, p.from_axis)) * sqrt(shade);
  seen += gloss * lamp_colours[1] * look_mirrored_box * soft_box * shade;
  // The tear meniscus along the lower lid catches light from above.
  float tears = Ramp(look_tears_edge, p.above_lower - look_lower_lid_rises * p.narrower) *
                Ramp(look_tears_beside, abs(p.beside));
  seen += gloss * look_mirrored_tears * tears * light;
  seen += gloss * Ambient(mirrored) * Fresnel(dot(p.wet, p.to_viewer)) * shade * look_mirrored_room;
}

void main() {
  EyePoint p = FindEyePoint();
  vec3 base = pictured ? PhotographedWhite(p) : White(p);
  // The edge of the iris is soft in a photo, too.
  float edge = pictured ? Ramp(look_photo_iris_edge, p.from_axis)
                        : Ramp(look_iris_edge, p.from_axis);
  if (edge > 0.0) base = mix(base, IrisSeen(p), edge);
  float shade = pictured ? PhotoShade(p, edge, base) : LidShade(p);

  vec3 light = Ambient(p.normal) * look_eye_room;
  light += lamp_colours[0] * Wrapped(dot(p.normal, lamp_directions[0]), vec3(look_eye_wrap)) * look_eye_key;
  light += lamp_colours[1] * Wrapped(dot(p.normal, lamp_directions[1]), vec3(look_eye_wrap));
  light = beside_photo ? vec3(1.0) : light;
  vec3 seen = base * light * shade * mix(openness, 1.0, look_eye_open);
  AddMirrored(p, shade, light, seen);
  seen = max(seen, 0.0);
  colour = vec4(beside_photo ? lamp_brightness * FromLinear(seen) : ToScreen(seen), 1.0);
}
