#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <variant>
#include <vector>

#include "fsm/base/pi.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/hair_styles.h"
#include "fsm/head/paint_stream.h"

namespace fsm {
namespace {

/// The shape of hair that is combed back from the whole hairline. A place in it: azimuth of the
/// root at the hairline, within +-reach(); `up` 0 there .. 1 at the tie, or at the ends of short
/// hair.
class CombedShape {
 public:
  /// `skin`: only read here; the identity outlives this. REQUIRES: its hair is a CombedStyle.
  CombedShape(const Identity& identity, const MeshBuilder& skin)
      : style_(std::get<CombedStyle>(identity.hair)),
        hair_(identity.features->combed_hair),
        look_(identity),
        scalp_(skin) {}

  const Scalp& scalp() const { return scalp_; }
  /// Returns the direction of the tie from kHairCentre.
  glm::vec3 tie() const {
    return glm::normalize(
        glm::vec3(0, style_.tail.value().tie_y - kHairCentre.y, -hair_.tie.behind));
  }
  /// Only hair that is tied grows from behind the ears, too.
  float reach() const { return style_.tail ? 180 : hair_.swept.reach; }

  /// Returns the direction of a root from kHairCentre.
  glm::vec3 Root(float azimuth) const {
    const float round = glm::radians(azimuth);
    const float wander =
        hair_.wander.wide * std::sin(9 * round + 1) + hair_.wander.narrow * std::sin(31 * round);
    return HairDirection(azimuth, look_.HairlineElevation(azimuth) + wander);
  }
  /// Returns the angle from a root to the tie or to the ends, degrees.
  float Degrees(float azimuth) const {
    const auto angle = [](glm::vec3 a, glm::vec3 b) {
      return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0f, 1.0f)));
    };
    const glm::vec3 middle = Direction(azimuth, 0.5f);
    return angle(Direction(azimuth, 0), middle) + angle(middle, Direction(azimuth, 1));
  }
  glm::vec3 Direction(float azimuth, float up) const {
    const glm::vec3 root = Root(azimuth);
    if (style_.tail) {
      const glm::vec3 end = tie();
      const float angle = std::acos(std::clamp(glm::dot(root, end), -1.0f, 1.0f));
      return (std::sin((1 - up) * angle) * root + std::sin(up * angle) * end) /
             std::max(std::sin(angle), 1e-3f);
    }
    // Short hair passes over the crown or above the ear, and ends along the hairline behind.
    const auto& swept = hair_.swept;
    const float sign = azimuth < 0 ? -1.0f : 1.0f;
    const float share = std::abs(azimuth) / swept.reach;
    const float end_azimuth = swept.ends.At(share);
    const glm::vec3 end =
        HairDirection(sign * end_azimuth, look_.HairlineElevation(end_azimuth) + swept.end_above);
    const glm::vec3 crown = swept.crown + glm::vec3(style_.aside * swept.aside, 0, 0);
    const glm::vec3 above_ear = HairDirection(sign * swept.ear_azimuth, swept.ear_elevation);
    const glm::vec3 bend = glm::normalize(glm::mix(crown, above_ear, swept.to_ear.Ramp(share)));
    const float left = 1 - up;
    return glm::normalize(left * left * root + 2 * up * left * swept.bend * bend + up * up * end);
  }
  /// Returns the direction in which a hair lies on a smooth head.
  glm::vec3 Flow(float azimuth, float up) const {
    return glm::normalize(Direction(azimuth, up + 0.01f) - Direction(azimuth, up - 0.01f) +
                          glm::vec3(0, 0, -1e-5f));
  }
  /// Returns the thickness of the hair, millimetres.
  float Depth(glm::vec3 d, float degrees, float up) const {
    const auto& depth = hair_.depth;
    const float body = glm::mix(style_.side_mm, style_.top_mm, depth.top_over_y.Ramp(d.y)) *
                       depth.over_degrees.Ramp(degrees);
    return depth.edge + depth.behind * depth.behind_over_z.Ramp(d.z) +
           (style_.tail ? body + depth.gathered * depth.gathered_over_up.Ramp(up)
                        : body * depth.ends_over_up.Ramp(up));
  }
  glm::vec3 Point(float azimuth, float up, float out_mm) const {
    const glm::vec3 d = Direction(azimuth, up);
    const float degrees = up * Degrees(azimuth);
    const glm::vec3 p = scalp_.Over(d, Depth(d, degrees, up) + out_mm);
    if (style_.wave_mm <= 0) return p;
    const float phase = Phase(azimuth, degrees);
    const float swing = style_.wave_mm * hair_.waves.over_degrees.Ramp(degrees);
    return p + swing * (std::sin(phase) * glm::cross(d, Flow(azimuth, up)) +
                        hair_.waves.off * std::cos(phase) * d);
  }
  /// Returns the direction of the hairs at a place, with waves.
  glm::vec3 Along(float azimuth, float up) const {
    if (style_.wave_mm <= 0) return Flow(azimuth, up);
    return glm::normalize(Point(azimuth, up + 0.01f, 0) - Point(azimuth, up - 0.01f, 0) +
                          glm::vec3(0, 0, -1e-3f));
  }
  /// Returns how high a wave is there, -1..1; 1 without waves.
  float Crest(float azimuth, float up) const {
    if (style_.wave_mm <= 0) return 1;
    const float degrees = up * Degrees(azimuth);
    const float share = hair_.waves.over_degrees.Ramp(degrees);
    return glm::mix(1.0f, std::cos(Phase(azimuth, degrees)), share);
  }

  std::vector<SkinStroke> Hairline() const {
    const auto& hairline = hair_.hairline;
    std::vector<SkinStroke> hairs;
    for (int k = 0; k < static_cast<int>(hairline.count); ++k) {
      const float azimuth = hairline.azimuth * NoiseAt(k, PaintStream::kHairlinePlace);
      const float deviation = NoiseAt(k, PaintStream::kHairlineOff);
      const float degrees = hairline.middle + hairline.spread * deviation * std::abs(deviation);
      const float up = degrees / Degrees(azimuth);
      const glm::vec3 root = Direction(azimuth, up);
      if (scalp_.Over(root, 0).y < hairline.lowest) continue;
      hairs.push_back(
          look_.SkinHair(scalp_, root, Flow(azimuth, up), std::min(1.0f, 1 + deviation), k));
    }
    return hairs;
  }

 private:
  /// Neighbours wave nearly alike.
  float Phase(float azimuth, float degrees) const {
    const auto& waves = hair_.waves;
    const float round = glm::radians(azimuth);
    return 2 * kPi * degrees / waves.degrees + waves.round * std::sin(2 * round + 1) +
           waves.uneven * std::sin(7 * round);
  }

  const CombedStyle& style_;
  const Features::CombedHair& hair_;
  const HairLook look_;
  const Scalp scalp_;
};

/// Adds the hair of that shape to a mesh.
class CombedBuilder {
 public:
  CombedBuilder(const Identity& identity, MeshBuilder& mesh)
      : style_(std::get<CombedStyle>(identity.hair)),
        hair_(identity.features->combed_hair),
        palette_(identity.palette),
        look_(identity),
        shape_(identity, mesh),
        mesh_(mesh) {}

  std::size_t Build() {
    std::vector<glm::vec3> edge;
    for (int k = -22; k <= 22; ++k)
      edge.push_back(shape_.scalp().Over(shape_.Direction(4 * static_cast<float>(k), 0.03f), 0));
    look_.ShadeSkin(edge, hair_.edge.shade, mesh_);
    Shell();
    for (int k = 0; k < static_cast<int>(hair_.flyaways.count); ++k) Flyaway(k);
    if (style_.wave_mm > 0) {
      for (int k = 0; k < static_cast<int>(hair_.locks.count); ++k) Lock(k);
    }
    const std::size_t hangs_from = mesh_.position.size();
    if (style_.tail) {
      Tail();
      for (int k = 0; k < static_cast<int>(hair_.tail.locks); ++k) TailLock(k);
    }
    for (int k = 0; k < style_.loose; ++k) {
      for (const Side side : kSides) Loose(side, k);
    }
    return hangs_from;
  }

 private:
  void Shell() {
    constexpr float kRoundMm = 536;  // twice the width of the strands' picture
    constexpr int kEdgeRows = 4;
    const int around = style_.tail ? 64 : 42, rows = style_.tail ? 18 : 26;
    const auto edge_degrees = ListOf(hair_.edge.degrees);
    const auto edge_density = ListOf(hair_.edge.density);
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int r = 0; r < rows; ++r) {
      const auto row = static_cast<std::size_t>(r);
      for (int k = 0; k <= around; ++k) {
        // Columns are denser in front, where the way to the tie is longest.
        const float turn = 2 * static_cast<float>(k) / static_cast<float>(around) - 1;
        const float azimuth =
            shape_.reach() * (style_.tail ? glm::mix(turn * turn * turn, turn, 0.6f) : turn);
        const float degrees = shape_.Degrees(azimuth);
        // Where the way to the tie is short, as at the nape, the edge is narrower.
        const float step = std::min(1 / degrees, hair_.edge.most_up);
        const float edge_up = step * edge_degrees[kEdgeRows - 1];
        const float up = r < kEdgeRows ? step * edge_degrees[row]
                                       : glm::mix(edge_up, 1.0f,
                                                  static_cast<float>(r - kEdgeRows + 1) /
                                                      static_cast<float>(rows - kEdgeRows));
        const float ragged =
            r == 0 ? hair_.edge.ragged * NoiseAt(k % around, PaintStream::kCropEdge) : 0.0f;
        // Combed strands lie a little higher and lower than others.
        const float comb = hair_.shell.comb * NoiseAt(k % around, PaintStream::kPointed) *
                           SmoothStep(0, 0.3f, up) * SmoothStep(1, 0.8f, up);
        const glm::vec3 p = shape_.Point(azimuth, up + ragged, r < kEdgeRows ? 0 : comb);
        const glm::vec3 colour = glm::mix(palette_.hair, look_.StrandColour(3 * (k % around), r),
                                          hair_.shell.streaks.At(style_.tail ? 1.0f : 0.0f));
        const float gathered =
            style_.tail ? glm::mix(1.0f, hair_.shell.tie_light, SmoothStep(0.8f, 1, up)) : 1.0f;
        const float open = (r < kEdgeRows ? hair_.shell.edge_light : hair_.shell.light) *
                           (1 + hair_.shell.comb_light * comb +
                            hair_.waves.light * (shape_.Crest(azimuth, up) - 1)) *
                           gathered;
        mesh_.Add(p, colour, std::min(1.0f, open), Bone::kSkull);
        mesh_.strands.back() = {.along = shape_.Along(azimuth, up + ragged),
                                .density = r < kEdgeRows ? edge_density[row]
                                           : style_.tail ? 1.0f
                                                         : hair_.swept.thins.Ramp(up),
                                .across = hair_.shell.across.At(style_.tail ? 1.0f : 0.0f),
                                .tile_mm = {kRoundMm * azimuth / 360, -1.7f * up * degrees}};
      }
    }
    mesh_.Grid(Material::kHair, first, rows, around + 1, true);
  }

  /// Adds a lock on waved hair.
  void Lock(int k) {
    const auto& locks = hair_.locks;
    const int seed = k + 300;
    const float azimuth = locks.azimuth * ((2 * static_cast<float>(k) + 1) / locks.count - 1) +
                          locks.uneven * NoiseAt(seed, PaintStream::kLockPlace);
    const float from = locks.from.At(0.5f + 0.5f * NoiseAt(seed, PaintStream::kLockFrom));
    const float to = locks.to.At(NoiseAt(seed, PaintStream::kLockTo));
    const float lift = locks.lift.At(NoiseAt(seed, PaintStream::kLockLift));
    std::vector<glm::vec3> path;
    constexpr int kSteps = 11;
    float crests = 0;
    for (int s = 0; s <= kSteps; ++s) {
      const float v = static_cast<float>(s) / kSteps;
      const float drift = locks.drift * v * std::sin(locks.turns * v + static_cast<float>(k));
      const float up = glm::mix(from, to, v);
      path.push_back(shape_.Point(azimuth + drift, up, lift * std::sin(kPi * locks.arch.At(v))));
      crests += shape_.Crest(azimuth + drift, up);
    }
    look_.AddLock(path,
                  {.width_mm = locks.width.At(NoiseAt(seed, PaintStream::kLockWidth)),
                   .root_share = 0.5f,
                   .tip_share = locks.tip,
                   .fray_from = locks.fray_from,
                   .open = locks.light.At(crests / kSteps)},
                  seed, mesh_);
  }

  /// Adds a single hair that stands off those that are combed back.
  void Flyaway(int k) {
    const auto& flyaways = hair_.flyaways;
    const int seed = k + 1500;
    const float azimuth = flyaways.azimuth * NoiseAt(seed, PaintStream::kFlyawayPlace);
    const float from = flyaways.from.At(0.5f + 0.5f * NoiseAt(seed, PaintStream::kFlyawayFrom));
    const float length = flyaways.length * (1 + 0.5f * NoiseAt(seed, PaintStream::kFlyawayLength));
    const float drift = flyaways.drift * NoiseAt(seed, PaintStream::kFlyawayDrift);
    const float off = flyaways.off * (0.6f + 0.4f * NoiseAt(seed, PaintStream::kFlyawayOff));
    std::vector<glm::vec3> path;
    constexpr int kSteps = 9;
    for (int s = 0; s <= kSteps; ++s) {
      const float v = static_cast<float>(s) / kSteps;
      path.push_back(shape_.Point(azimuth + drift * v * v, std::min(from + length * v, 0.97f),
                                  off * std::sin(kPi * (0.1f + 0.8f * v))));
    }
    look_.AddLock(
        path, {.width_mm = flyaways.width, .tip_share = 0.3f, .fray_from = 0.9f, .single = true},
        seed, mesh_);
  }

  /// Returns a point of the tail's axis; s: 0 at the tie .. 1 at the end.
  glm::vec3 TailAxis(float s) const {
    const glm::vec3 from = shape_.scalp().Over(shape_.tie(), hair_.tail.root);
    const glm::vec3 end{0, style_.tail.value().end_y, -hair_.tail.end_behind};
    const glm::vec3 one = from + hair_.tail.rises;
    const glm::vec3 two = end + hair_.tail.falls * glm::vec3(1, from.y - end.y, 1);
    const float u = 1 - s;
    return u * u * u * from + 3 * u * u * s * one + 3 * u * s * s * two + s * s * s * end;
  }
  glm::vec3 TailAlong(float s) const {
    return glm::normalize(TailAxis(s + 0.02f) - TailAxis(s - 0.02f));
  }
  /// Returns the direction from the axis to its surface; `turn` in radians, 0 = away from the head.
  glm::vec3 TailOut(float s, float turn) const {
    const glm::vec3 aside(1, 0, 0);
    const glm::vec3 off = glm::normalize(glm::cross(TailAlong(s), aside));
    return std::sin(turn) * aside - std::cos(turn) * off * (off.z > 0 ? 1.0f : -1.0f);
  }
  float TailRadius(float s) const {
    const auto& tail = hair_.tail;
    return glm::mix(tail.tie_radius, tail.radius, SmoothStep(0, tail.widest, s)) *
           glm::mix(1.0f, tail.end_share, SmoothStep(tail.widest, 1.1f, s));
  }
  glm::vec3 TailPoint(float s, float turn, float out_mm) const {
    const glm::vec3 out = TailOut(s, turn);
    const float wave =
        hair_.tail.wave * SmoothStep(0, 0.5f, s) * std::sin(2 * kPi * hair_.tail.waves * s + turn);
    return TailAxis(s) + out * (TailRadius(s) + out_mm) * glm::vec3(hair_.tail.wide, 1, 1) +
           glm::vec3(wave, 0, 0);
  }

  void Tail() {
    const auto& tail = hair_.tail;
    constexpr int kAround = 14, kRows = 12;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int r = 0; r <= kRows; ++r) {
      const float s = static_cast<float>(r) / kRows;
      for (int k = 0; k <= kAround; ++k) {
        const float turn = 2 * kPi * static_cast<float>(k) / kAround;
        const float tip = s * (1 + tail.uneven * NoiseAt(k % kAround, PaintStream::kPointed) * s);
        const glm::vec3 p = TailPoint(tip, turn, 0);
        // What faces the neck is in the shade, and so are the hairs at the tie.
        const float open = glm::mix(tail.inside_light, 1.0f, 0.5f + 0.5f * std::cos(turn)) *
                           glm::mix(tail.tie_light, 1.0f, SmoothStep(0, 0.16f, s));
        const glm::vec3 colour = look_.StrandColour(5 * (k % kAround) + 200, r);
        mesh_.Add(p, glm::mix(palette_.hair, colour, hair_.shell.streaks.At(1.0f)), open,
                  Bone::kSkull);
        mesh_.strands.back() = {.along = TailAlong(s),
                                .density = tail.thins.Ramp(s),
                                .tile_mm = {80 * turn / (2 * kPi), 170 * s}};
      }
    }
    mesh_.Grid(Material::kHair, first, kRows + 1, kAround + 1, false);
    Band();
  }

  /// Adds the strand that is wound around the tail where it begins.
  void Band() {
    const auto& band = hair_.band;
    constexpr int kAround = 14, kRows = 4;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int r = 0; r <= kRows; ++r) {
      const float v = static_cast<float>(r) / kRows;
      const float s = band.at.At(v);
      for (int k = 0; k <= kAround; ++k) {
        const float turn = 2 * kPi * static_cast<float>(k) / kAround;
        const glm::vec3 p = TailPoint(s, turn, band.thick * std::sin(kPi * v));
        mesh_.Add(p, palette_.hair * band.colour, band.light.At(std::sin(kPi * v)), Bone::kSkull);
        mesh_.strands.back() = {.along = TailOut(s, turn + 0.5f * kPi),
                                .tile_mm = {12 * v, 80 * turn / (2 * kPi)}};
      }
    }
    mesh_.Grid(Material::kHair, first, kRows + 1, kAround + 1, false);
  }

  void TailLock(int k) {
    const auto& locks = hair_.tail_locks;
    const int seed = k + 700;
    const float turn = 2 * kPi *
                       (static_cast<float>(k) + 0.4f * NoiseAt(seed, PaintStream::kLockPlace)) /
                       hair_.tail.locks;
    const float from = locks.from.At(0.5f + 0.5f * NoiseAt(seed, PaintStream::kLockFrom));
    const float to = locks.to.At(NoiseAt(seed, PaintStream::kLockTo));
    std::vector<glm::vec3> path;
    constexpr int kSteps = 8;
    for (int s = 0; s <= kSteps; ++s) {
      const float v = static_cast<float>(s) / kSteps;
      const float drift = locks.drift * std::sin(4 * v + static_cast<float>(k));
      path.push_back(TailPoint(glm::mix(from, to, v), turn + drift,
                               locks.lift * std::sin(kPi * (0.1f + 0.75f * v))));
    }
    look_.AddLock(path,
                  {.width_mm = locks.width.At(NoiseAt(seed, PaintStream::kLockWidth)),
                   .root_share = 0.5f,
                   .tip_share = locks.tip,
                   .fray_from = locks.fray_from,
                   .open = glm::mix(hair_.tail.inside_light, 1.0f, 0.5f + 0.5f * std::cos(turn)),
                   .outward = TailOut(0.5f, turn)},
                  seed, mesh_);
  }

  /// Adds a strand that is too short for the tie: from the top of the forehead it falls past the
  /// temple and hangs beside the cheek. k: 0 is the outermost one.
  void Loose(Side side, int k) {
    const auto& loose = hair_.loose;
    const int seed = 3 * k + (side == Side::kLeft ? 900 : 800);
    const float share = static_cast<float>(k) / static_cast<float>(std::max(style_.loose - 1, 1));
    const auto differs = [seed](PaintStream stream, float by) {
      return by * NoiseAt(seed, stream);
    };
    const float begins = loose.begins.At(share) + differs(PaintStream::kLockPlace, loose.uneven);
    const float temple = loose.temple.At(share) + differs(PaintStream::kLockFrom, loose.uneven);
    const float ends = loose.ends.At(share) + differs(PaintStream::kLockTo, 3 * loose.uneven);
    const std::array<glm::vec3, 4> bend{
        // azimuth, elevation, distance from the skin
        glm::vec3(begins, look_.HairlineElevation(begins) + loose.root.x, loose.root.y),
        glm::vec3(loose.over.x, look_.HairlineElevation(loose.over.x) + loose.over.y, loose.over.z),
        glm::vec3(temple, loose.past.x, loose.past.y),
        glm::vec3(temple + loose.back, ends, loose.end_off)};
    const float phase = 3 * NoiseAt(seed, PaintStream::kLockLift);
    std::vector<glm::vec3> path;
    constexpr int kSteps = 11;
    for (int s = 0; s <= kSteps; ++s) {
      const float v = static_cast<float>(s) / kSteps, u = 1 - v;
      glm::vec3 at = u * u * u * bend[0] + 3 * u * u * v * bend[1] + 3 * u * v * v * bend[2] +
                     v * v * v * bend[3];
      at.x += loose.wave * v * v * std::sin(2 * kPi * loose.waves * v + phase);
      path.push_back(shape_.scalp().Over(HairDirection(SignOf(side) * at.x, at.y), at.z));
    }
    look_.AddLock(path,
                  {.width_mm = loose.width.At(NoiseAt(seed, PaintStream::kLockWidth)),
                   .root_share = 0.6f,
                   .tip_share = loose.tip,
                   .fray_from = loose.fray_from},
                  seed, mesh_);
  }

  const CombedStyle& style_;
  const Features::CombedHair& hair_;
  const Palette& palette_;
  const HairLook look_;
  const CombedShape shape_;
  MeshBuilder& mesh_;
};

}  // namespace

std::size_t BuildCombedHair(const Identity& identity, MeshBuilder& mesh) {
  const auto& style = std::get<CombedStyle>(identity.hair);
  if (!style.tail) {
    // Shorter hair below, which is seen at the sides, before the ears and at the nape.
    const auto& under = identity.features->combed_hair.under;
    Identity cropped = identity;
    cropped.hair = CropStyle{.side_mm = under.sides * style.side_mm,
                             .top_mm = under.top * style.top_mm,
                             .locks = 0,
                             .lock_mm = 0,
                             .lift_mm = 0,
                             .wave_mm = 0,
                             .front_up = 0,
                             .recede = 0};
    BuildCroppedHair(cropped, mesh, under.up_to);
  }
  return CombedBuilder(identity, mesh).Build();
}

std::vector<SkinStroke> CombedHairline(const Identity& identity, const MeshBuilder& skin) {
  return CombedShape(identity, skin).Hairline();
}

}  // namespace fsm
