#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "fsm/base/pi.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/hair_styles.h"
#include "fsm/head/paint_stream.h"

namespace fsm {
namespace {

/// The shape of parted hair. Strands start along the parting, sweep over the skull and hang down.
/// Those at the face's edge frame the forehead in a round arch, slightly off the skin. A place in
/// the hair of one side: `around` runs from the face's edge (0) to the middle of the back (1);
/// `along` from the parting (0) over the end of the skull (kCap) to the ends (kEnd).
class LongShape {
 public:
  static constexpr float kCap = 0.58f, kEnd = 1.0f;

  /// `skin`: only read here; the identity outlives this. REQUIRES: its hair is a LongStyle.
  LongShape(const Identity& identity, const MeshBuilder& skin)
      : style_(std::get<LongStyle>(identity.hair)),
        hair_(identity.features->long_hair),
        volume_(hair_.volume.half_axes + style_.full_mm),
        look_(identity),
        scalp_(skin),
        cloth_(ClothOf(skin)) {
    if (style_.fringe_y) FindCover();
  }

  /// Returns a place, `out_mm` farther out than the surface of the hair.
  glm::vec3 Point(float around, Side side, float along, float out_mm) const {
    const float cap = std::min(1.0f, along / kCap);
    const glm::vec3 d = Direction(around, side, cap);
    const float radius = Radius(around, d, cap);
    glm::vec3 p = kHairCentre + d * (radius + out_mm);
    p.x += SignOf(side) * OverEar(around, p.y) * (1 - Tucked(side));
    return along > kCap ? Hanging(around, side, (along - kCap) / (kEnd - kCap), d, radius, p) : p;
  }

  /// Returns the direction of hairs at a place.
  glm::vec3 Along(float around, Side side, float along) const {
    const auto& parting = hair_.parting;
    const glm::vec3 direction =
        glm::normalize(Point(around, side, along + 0.02f, 0) -
                       Point(around, side, along - 0.02f, 0) + glm::vec3(0, -1e-3f, 0));
    // At the parting the hairs of both sides rise alike, or the shading would have an edge there.
    const float turned = SmoothStep(0, parting.direction_until, along);
    return glm::normalize(glm::mix(parting.direction, direction, turned));
  }

  /// Returns a place in the fringe: `aside` from the agent's right (-1) to the left (1); `down`
  /// from where it begins (0) to its ends (1); `out_mm` farther out than its surface. REQUIRES: the
  /// style has one.
  glm::vec3 InFringe(float aside, float down, float out_mm) const {
    const auto& fringe = hair_.fringe;
    const float azimuth = fringe.spread * aside;
    const float end_y =
        *style_.fringe_y - fringe.lower * std::pow(std::abs(aside), fringe.lower_power);
    const float end_radius = scalp_.Distance(HairDirection(azimuth, 0)) + fringe.off_skin;
    const float end =
        glm::degrees(std::asin(std::clamp((end_y - kHairCentre.y) / end_radius, -1.0f, 1.0f)));
    const glm::vec3 d =
        HairDirection(azimuth, glm::mix(fringe.begins.At(aside * aside), end, down));
    const float over_hair = fringe.over_hair.At(fringe.over_down.Ramp(down));
    const float radius = std::max(scalp_.Distance(d) + fringe.off_skin, CoveredUpTo(d) + over_hair);
    return kHairCentre + d * (radius + out_mm);
  }

  /// Returns how far the surface is raised there, millimetres.
  float Ridge(float around, float along) const {
    const auto& ridges = hair_.ridges;
    const float phase = ridges.close * around + 2.0f * std::sin(3 * along + 9 * around);
    return (ridges.broad * std::sin(phase) + ridges.narrow * std::sin(ridges.closer * phase + 1)) *
           ridges.over_along.Ramp(along) * ridges.deep.At(along) * ridges.over_around.Ramp(around);
  }

  /// Returns how much higher a column ends than the longest ones; neighbours differ.
  float Pointed(int column, float along) const {
    const auto& ends = hair_.ends;
    const float share = 0.5f + 0.5f * NoiseAt(column, PaintStream::kPointed);
    return ends.points * (column % 2 == 0 ? 0.4f * share : 0.6f + 0.4f * share) *
           ends.points_over_along.Ramp(along);
  }

  std::vector<SkinStroke> Hairline() const {
    const auto& hairline = hair_.hairline;
    std::vector<SkinStroke> hairs;
    for (int k = 0; k < static_cast<int>(hairline.count); ++k) {
      const Side side = k % 2 == 0 ? Side::kRight : Side::kLeft;
      const float cap = hairline.to * (0.5f + 0.5f * NoiseAt(k, PaintStream::kHairlinePlace));
      const glm::vec3 edge = Direction(0, side, cap);
      const glm::vec3 direction = glm::normalize(Direction(0, side, cap + 0.02f) - edge);
      const float deviation = NoiseAt(k, PaintStream::kHairlineOff);
      const glm::vec3 before = SignOf(side) * glm::cross(direction, edge);  // away from the hair
      const float away = hairline.before + hairline.spread * deviation * std::abs(deviation);
      const glm::vec3 root = glm::normalize(edge + before * away);
      if (scalp_.Over(root, 0).y < hairline.lowest) continue;
      hairs.push_back(look_.SkinHair(scalp_, root, direction + hairline.turn * before,
                                     std::min(1.0f, 1 - deviation), k));
    }
    return hairs;
  }

 private:
  static std::vector<glm::vec3> ClothOf(const MeshBuilder& mesh) {
    std::vector<glm::vec3> cloth;
    for (std::size_t i = 0; i < mesh.position.size(); ++i) {
      if (mesh.bone[i] == Bone::kSkin && mesh.weights[i].skin.neck <= 0)
        cloth.push_back(mesh.position[i]);
    }
    return cloth;
  }

  float Tucked(Side side) const { return side == Side::kLeft ? style_.tucked : 0.0f; }

  glm::vec3 OnParting(float degrees) const {
    const float along = degrees * kPi / 180;
    const float wander = std::sin(0.31f * degrees) + 0.7f * std::sin(0.83f * degrees + 1);
    return glm::normalize(glm::vec3(style_.parting + hair_.parting.wander * wander, std::sin(along),
                                    std::cos(along)));
  }

  /// Returns the direction from kHairCentre of a place over the skull; `cap`: 0 at the parting, 1
  /// at the skull's end.
  glm::vec3 Direction(float around, Side side, float cap) const {
    const glm::vec3 start =
        OnParting(hair_.parting.degrees.At(std::pow(around, hair_.strands.parting_power)));
    const float sign = SignOf(side);
    const float tucked = Tucked(side);
    const float first = glm::mix(hair_.strands.degrees.from, hair_.tuck.begins, tucked);
    const float azimuth =
        glm::mix(first, hair_.strands.degrees.to, std::pow(around, hair_.strands.around_power));
    const float edge = hair_.bend.edge_over_around.Ramp(around);
    // On the side away from the parting the way around the forehead is longer.
    const float away = side == Side::kRight ? 1.0f : 0.0f;
    const float nearer =
        glm::mix(hair_.bend.nearer - hair_.bend.nearer_less_away * away, hair_.tuck.nearer, tucked);
    const float edge_bend =
        glm::mix(hair_.bend.edge - hair_.bend.edge_less_away * away, hair_.tuck.bend, tucked);
    const glm::vec3 bend = HairDirection(sign * azimuth * glm::mix(1.0f, nearer, edge),
                                         glm::mix(hair_.bend.behind, edge_bend, edge));
    const glm::vec3 end = HairDirection(
        sign * azimuth, glm::mix(hair_.skull_end.At(edge), hair_.tuck.skull_end, tucked * edge));
    return glm::normalize((1 - cap) * (1 - cap) * start + 2 * cap * (1 - cap) * bend +
                          cap * cap * end);
  }

  /// Returns how far from kHairCentre hair over the skull lies in the direction `d`.
  float Radius(float around, glm::vec3 d, float cap) const {
    const auto& off = hair_.off;
    const glm::vec3 scaled = d / volume_;
    const float volume = 1 / std::sqrt(glm::dot(scaled, scaled));
    const float skin = scalp_.Distance(d);
    const float share = hair_.volume.over_around.Ramp(around) *
                        hair_.volume.share.At(hair_.volume.over_cap.Ramp(cap));
    const float fringe = off.forehead + off.middle * std::sin(kPi * SmoothStep(0, 1, cap));
    const float least = skin + glm::mix(fringe, off.others, off.others_over_around.Ramp(around));
    const float radius =
        std::max(least, glm::mix(skin + off.forehead + off.temples * off.temples_over_cap.Ramp(cap),
                                 volume, share));
    // The parting is a furrow in the hair.
    return glm::mix(skin + hair_.furrow.share * (radius - skin), radius,
                    hair_.furrow.over_cap.Ramp(cap));
  }

  float EndY(float around, Side side) const {
    const auto& ends = hair_.ends;
    const float sign = SignOf(side);
    const float end =
        glm::mix(style_.front_y, style_.back_y, std::sqrt(ends.over_around.Ramp(around)));
    // What would lie on top of the shoulder ends above it.
    const float lowest = glm::mix(std::min(style_.front_y, style_.back_y), ends.shoulder,
                                  Bell(around - ends.shoulder_around, ends.shoulder_width));
    return std::max(end, lowest) +
           ends.uneven * (std::sin(17 * around + sign) +
                          ends.shorter_waves * std::sin(43 * around + 2 * sign));
  }

  /// Returns the place of a strand that hangs: `hang` runs from the end of the skull (0), where it
  /// is `p`, in the direction `d` and `radius` from kHairCentre, to its own end (1).
  glm::vec3 Hanging(float around, Side side, float hang, glm::vec3 d, float radius,
                    glm::vec3 p) const {
    const auto& hanging = hair_.hanging;
    const glm::vec3 out = glm::normalize(glm::vec3(d.x, 0, d.z));
    const float front = hanging.edge_over_around.Ramp(around) * (1 - Tucked(side));
    p.y = glm::mix(p.y, EndY(around, side), hang);
    // It continues around the skull for a little, so that it has no kink where that ends.
    const glm::vec3 on = (d - Direction(around, side, 1 - hanging.direction_step)) * radius *
                         (1 - kCap) / (kCap * hanging.direction_step);
    p += glm::vec3(on.x, 0, on.z) * hang * std::exp(-hang / hanging.goes_on);
    const float full =
        hanging.full.At(front) * std::sin(std::min(1.0f, hanging.full_half_waves * hang) * kPi);
    p += out * (full -
                hanging.inward.At(hanging.inward_over_around.Ramp(around)) * hang * hang * hang) +
         Wave(around, side, hang, out);
    p.z += front * hanging.forward * hang * (1 - hanging.forward_less_ends * hang);
    // Beside the face it follows the cheek.
    p.x -= SignOf(side) * front * hanging.cheek *
           std::sin(std::min(1.0f, hanging.cheek_quarter_waves * hang) * kPi * 0.5f);
    return OffBody(around, p);
  }

  /// Moves a place before or behind the shoulder, if it is not.
  glm::vec3 OffBody(float around, glm::vec3 p) const {
    const auto& shoulder = hair_.shoulder;
    // Exceeds 0 smoothly, so that hair does not bend where it comes to lie on cloth.
    const auto above = [&shoulder](float x) {
      return x > 20 * shoulder.soft ? x : shoulder.soft * std::log1p(std::exp(x / shoulder.soft));
    };
    float before = -1000, behind = 1000;
    for (const glm::vec3 c : cloth_) {
      const glm::vec2 aside = glm::vec2(p) - glm::vec2(c);
      const float round = glm::dot(aside, aside) / shoulder.round;
      before = std::max(before, c.z - round + shoulder.off);
      behind = std::min(behind, c.z + round - shoulder.off);
    }
    p.z = glm::mix(behind - above(behind - p.z), before + above(p.z - before),
                   shoulder.over_around.Ramp(around));
    return p;
  }

  /// Returns the wave of hanging hair: around the head and, less, off it; neighbours move alike.
  glm::vec3 Wave(float around, Side side, float hang, glm::vec3 out) const {
    const auto& waves = hair_.waves;
    const float sign = SignOf(side);
    const float phase = 2 * kPi * waves.count * hang + waves.round * around + waves.sides * sign;
    const float swing = style_.wave_mm * waves.over_hang.Ramp(hang);
    return swing * (std::sin(phase) * glm::vec3(out.z, 0, -out.x) * sign +
                    waves.off * std::cos(phase) * out);
  }

  /// Remembers where the hair over the skull lies.
  void FindCover() {
    constexpr int kSteps = 24;
    for (const Side side : kSides) {
      for (int k = 0; k <= kSteps; ++k) {
        for (int row = 0; row <= kSteps; ++row) {
          const float around = hair_.fringe.reach * static_cast<float>(k) / kSteps;
          const float along = kCap * static_cast<float>(row) / kSteps;
          const float ridge = std::max(0.0f, Ridge(around, along));
          const glm::vec3 from = Point(around, side, along, ridge) - kHairCentre;
          cover_.emplace_back(glm::normalize(from), glm::length(from));
        }
      }
    }
  }

  /// Returns how far from kHairCentre that hair lies in a direction; beyond its edge, where other
  /// hair that falls over it would.
  float CoveredUpTo(glm::vec3 d) const {
    float farthest = 0;
    for (const auto& [direction, radius] : cover_) {
      const float lower = hair_.fringe.drape * (1 - glm::dot(direction, d));
      farthest = std::max(farthest, radius - lower);
    }
    return farthest;
  }

  /// Returns how far the ear lifts the hair that hangs over it.
  float OverEar(float around, float y) const {
    const auto& over_ear = hair_.over_ear;
    const float round = (around - over_ear.round) / over_ear.half_width;
    const float up = (y - over_ear.y) / over_ear.half_height;
    return over_ear.lift * std::exp(-round * round - up * up);
  }

  const LongStyle& style_;
  const Features::LongHair& hair_;
  const glm::vec3 volume_;
  const HairLook look_;
  const Scalp scalp_;
  const std::vector<glm::vec3> cloth_;
  std::vector<std::pair<glm::vec3, float>> cover_{};  // directions and distances
};

/// Adds the hair of that shape to a mesh.
class LongHairBuilder {
 public:
  LongHairBuilder(const Identity& identity, MeshBuilder& mesh)
      : style_(std::get<LongStyle>(identity.hair)),
        hair_(identity.features->long_hair),
        palette_(identity.palette),
        look_(identity),
        shape_(identity, mesh),
        mesh_(mesh) {}

  void Build() {
    Shade();
    const std::size_t first = mesh_.position.size();
    for (const Side side : kSides) {
      Shell(side);
      Lining(side);
      Locks(side);
      for (int k = 0; k < static_cast<int>(hair_.frame.count); ++k) FrameLock(side, k);
      Flyaways(side);
    }
    if (style_.fringe_y) {
      FringeSheet();
      for (int k = 0; k < static_cast<int>(hair_.fringe.count); ++k) FringeLock(k);
    }
    // What lies on the shoulders stays there as the head turns.
    for (std::size_t i = first; i < mesh_.position.size(); ++i)
      mesh_.weights[i].skin.neck = hair_.shoulder.turns_over_y.Ramp(mesh_.position[i].y);
  }

 private:
  void Shade() {
    const auto& neck_shade = hair_.neck_shade;
    std::vector<glm::vec3> edge;
    for (const Side side : kSides) {
      for (int k = 0; k <= 48; ++k)
        edge.push_back(shape_.Point(0, side, 0.02f * static_cast<float>(k), 0));
    }
    for (int k = -30; style_.fringe_y && k <= 30; ++k)
      edge.push_back(shape_.InFringe(static_cast<float>(k) / 30, 1, 0));
    look_.ShadeSkin(edge, hair_.edge_shade, mesh_);
    for (std::size_t i = 0; i < mesh_.position.size(); ++i) {
      const glm::vec3 p = mesh_.position[i];
      if (mesh_.bone[i] != Bone::kSkin) continue;
      const float behind = neck_shade.over_z.Ramp(p.z) * neck_shade.over_y.Ramp(p.y) *
                           (style_.back_y + neck_shade.above_ends).Ramp(p.y);
      mesh_.openness[i] *= 1 - neck_shade.dark * behind;
    }
  }

  void Shell(Side side) {
    const auto& light = hair_.light;
    constexpr int kStrands = 22;
    constexpr int kCapRows = 16;  // the skull is round; hanging hair is nearly straight
    constexpr int kRows = 26;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Strands are denser at the face, where the edge is visible.
      const float u = static_cast<float>(k) / kStrands;
      const float around = glm::mix(u * u, u, hair_.shell.even);
      for (int row = 0; row <= kRows; ++row) {
        // The first two rows are the parting, where the scalp is visible.
        const float along =
            row == 1 ? hair_.parting.scalp_until
            : row <= kCapRows
                ? LongShape::kCap * static_cast<float>(std::max(row - 1, 0)) / (kCapRows - 1)
                : glm::mix(LongShape::kCap, LongShape::kEnd,
                           static_cast<float>(row - kCapRows) / (kRows - kCapRows));
        glm::vec3 p = shape_.Point(around, side, along, shape_.Ridge(around, along));
        p.y += shape_.Pointed(k, along);
        const float open =
            std::min(1.0f, glm::mix(light.parting, 1.0f, light.parting_over_along.Ramp(along)) *
                               glm::mix(light.edge, 1.0f, light.edge_over_around.Ramp(around)) *
                               (1 + light.ridges * shape_.Ridge(around, along)));
        const glm::vec3 colour = look_.StrandColour(k * 3, row) * light.along.At(along);
        mesh_.Add(p, row > 0 ? colour : glm::mix(colour, palette_.skin, hair_.parting.scalp), open,
                  Bone::kSkull);
        const float edge =
            glm::mix(hair_.density.edge, 1.0f, hair_.density.over_around.Ramp(around));
        mesh_.strands.back() = {.along = shape_.Along(around, side, along),
                                .density = edge * hair_.density.over_along.Ramp(along),
                                .tile_mm = hair_.tile * glm::vec2(SignOf(side) * around, along)};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side == Side::kLeft);
  }

  /// Adds the fringe below its locks.
  void FringeSheet() {
    const auto& fringe = hair_.fringe;
    constexpr int kStrands = 32;
    constexpr int kRows = 12;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      const float aside = 2 * static_cast<float>(k) / kStrands - 1;
      const float length = 1 - fringe.uneven * (0.5f + 0.5f * NoiseAt(k, PaintStream::kPointed));
      for (int row = 0; row <= kRows; ++row) {
        const float down = length * static_cast<float>(row) / kRows;
        const float phase = fringe.ridges_close * aside + 2 * std::sin(3 * down);
        const glm::vec3 along =
            shape_.InFringe(aside, down + 0.02f, 0) - shape_.InFringe(aside, down - 0.02f, 0);
        mesh_.Add(shape_.InFringe(aside, down, fringe.ridges * std::sin(phase)),
                  look_.StrandColour(k * 2, row), fringe.light, Bone::kSkull);
        mesh_.strands.back() = {.along = glm::normalize(along + glm::vec3(0, -1e-3f, 0)),
                                .density = fringe.begins_over_down.Ramp(down) *
                                           fringe.thins_over_down.Ramp(down) *
                                           fringe.thins_aside.Ramp(std::abs(aside)),
                                .across = 0,
                                .tile_mm = fringe.tile * glm::vec2(aside, down)};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, true);
  }

  void FringeLock(int k) {
    const auto& fringe = hair_.fringe;
    const int seed = k + 2100;
    const float place =
        static_cast<float>(k) + 0.5f + 0.5f * NoiseAt(seed, PaintStream::kLockPlace);
    const float aside = fringe.widest * (2 * place / fringe.count - 1);
    const float from = fringe.from.At(NoiseAt(seed, PaintStream::kLockFrom));
    const float to = fringe.to.At(NoiseAt(seed, PaintStream::kLockTo));
    const float lift = fringe.lift.At(NoiseAt(seed, PaintStream::kLockLift));
    const float lean = fringe.lean * NoiseAt(seed, PaintStream::kLockLean);
    std::vector<glm::vec3> path;
    constexpr int kSteps = 8;
    for (int s = 0; s <= kSteps; ++s) {
      const float v = static_cast<float>(s) / kSteps;
      path.push_back(shape_.InFringe(aside + lean * v * v, glm::mix(from, to, v),
                                     lift * SmoothStep(0, 0.25f, v)));
    }
    look_.AddLock(path,
                  {.width_mm = fringe.width.At(NoiseAt(seed, PaintStream::kLockWidth)),
                   .root_share = fringe.root,
                   .tip_share = fringe.tip,
                   .fray_from = fringe.fray_from},
                  seed, mesh_);
  }

  /// Adds the dark inside of the hair, visible beside the neck and beyond the far temple.
  void Lining(Side side) {
    const auto& lining = hair_.lining;
    constexpr int kStrands = 11;
    constexpr int kRows = 6;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Beside the face it reaches up to the forehead, where one looks under the hair.
      const float u = static_cast<float>(k) / kStrands;
      const float around = glm::mix(lining.begins, 1.0f, glm::mix(u * u, u, lining.even));
      const float behind = lining.over_around.Ramp(around);
      for (int row = 0; row <= kRows; ++row) {
        const float along = glm::mix(LongShape::kCap * lining.top * behind, LongShape::kEnd,
                                     static_cast<float>(row) / kRows);
        const float inset =
            glm::mix(lining.inset_face, lining.inset[static_cast<std::size_t>(row)], behind);
        const glm::vec3 p =
            shape_.Point(around, side, along, inset) + glm::vec3(0, shape_.Pointed(k, along), 0);
        mesh_.Add(p, palette_.hair, lining.light, Bone::kSkull);
        // It thins out less at its outline than the shell, which surrounds it.
        mesh_.strands.back() = {.along = shape_.Along(around, side, along),
                                .density = hair_.density.over_along.Ramp(along) *
                                           hair_.density.over_around.Ramp(around),
                                .across = lining.across,
                                .tile_mm = hair_.tile * glm::vec2(around, along)};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side == Side::kRight);
  }

  void Locks(Side side) {
    const auto& locks = hair_.locks;
    const int count = static_cast<int>(locks.count);
    for (int k = 0; k < count; ++k) {
      const int seed = k + (side == Side::kLeft ? 500 : 0);
      const float around =
          (static_cast<float>(k) + 0.5f + 0.4f * NoiseAt(seed, PaintStream::kLockPlace)) /
          static_cast<float>(count);
      const float from = locks.from.At(NoiseAt(seed, PaintStream::kLockFrom) + 1);
      const float to = locks.to.At(NoiseAt(seed, PaintStream::kLockTo));
      const float lift = locks.lift.At(NoiseAt(seed, PaintStream::kLockLift));
      std::vector<glm::vec3> path;
      constexpr int kSteps = 11;
      for (int s = 0; s <= kSteps; ++s) {
        // Steps are shorter over the skull, which is round.
        const float v = std::pow(static_cast<float>(s) / kSteps, locks.crowd_power);
        const float drift = locks.drift * v * std::sin(locks.turns * v + 2 * static_cast<float>(k));
        path.push_back(shape_.Point(std::clamp(around + drift, 0.0f, 1.0f), side,
                                    glm::mix(from, to, v),
                                    lift * std::sin(kPi * locks.arch.At(v))));
      }
      look_.AddLock(path,
                    {.width_mm = locks.width.At(NoiseAt(seed, PaintStream::kLockWidth)),
                     .root_share = locks.root,
                     .tip_share = locks.tip,
                     .fray_from = locks.fray_from},
                    seed, mesh_);
    }
  }

  /// Adds a thin lock at the edge, nearer to the face than the others. Tucked hair has none.
  void FrameLock(Side side, int k) {
    if (side == Side::kLeft && style_.tucked > 0.5f) return;
    const auto& frame = hair_.frame;
    const int seed = k + (side == Side::kLeft ? 1300 : 1100);
    const float nearer = frame.nearer.At(NoiseAt(seed, PaintStream::kLockPlace));
    const float from = frame.from.At(NoiseAt(seed, PaintStream::kLockFrom));
    const float to = frame.to.At(NoiseAt(seed, PaintStream::kLockTo));
    const float phase = 3 * NoiseAt(seed, PaintStream::kLockLift);
    std::vector<glm::vec3> path;
    constexpr int kSteps = 14;
    for (int s = 0; s <= kSteps; ++s) {
      const float v = static_cast<float>(s) / kSteps;
      const float along = glm::mix(from, to, v);
      glm::vec3 p = shape_.Point(frame.around, side, along,
                                 frame.lift * std::sin(kPi * std::min(1.0f, 0.15f + v)));
      p.x -= SignOf(side) * v *
             (nearer * std::sin(kPi * v) + frame.wave * std::sin(frame.turns * v + phase));
      path.push_back(p);
    }
    look_.AddLock(path,
                  {.width_mm = frame.width.At(NoiseAt(seed, PaintStream::kLockWidth)),
                   .root_share = 0.5f,
                   .tip_share = 0.2f,
                   .fray_from = 0.7f},
                  seed, mesh_);
  }

  /// Adds single hairs that stand off the others.
  void Flyaways(Side side) {
    const auto& flyaways = hair_.flyaways;
    for (int k = 0; k < static_cast<int>(flyaways.count); ++k) {
      const int seed = k + (side == Side::kLeft ? 1700 : 1500);
      const float around = flyaways.around.At(NoiseAt(seed, PaintStream::kFlyawayPlace));
      const float from = flyaways.from * (0.5f + 0.5f * NoiseAt(seed, PaintStream::kFlyawayFrom));
      const float length =
          flyaways.length * (1 + 0.5f * NoiseAt(seed, PaintStream::kFlyawayLength));
      const float drift = flyaways.drift * NoiseAt(seed, PaintStream::kFlyawayDrift);
      // Most lie close to the others, above all on the skull; few stand far off.
      const float distance = 0.5f + 0.5f * NoiseAt(seed, PaintStream::kFlyawayOff);
      const float deviation =
          flyaways.off * (0.3f + 1.4f * distance * distance) * flyaways.off_over_along.Ramp(from);
      std::vector<glm::vec3> path;
      constexpr int kSteps = 6;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        path.push_back(shape_.Point(std::clamp(around + drift * v * v, 0.0f, 1.0f), side,
                                    from + length * v,
                                    deviation * std::sin(kPi * flyaways.arch.At(v))));
      }
      look_.AddLock(path,
                    {.width_mm = flyaways.width,
                     .tip_share = flyaways.tip,
                     .fray_from = flyaways.fray_from,
                     .single = true},
                    seed, mesh_);
    }
  }

  const LongStyle& style_;
  const Features::LongHair& hair_;
  const Palette& palette_;
  const HairLook look_;
  const LongShape shape_;
  MeshBuilder& mesh_;
};

}  // namespace

void BuildLongHair(const Identity& identity, MeshBuilder& mesh) {
  LongHairBuilder(identity, mesh).Build();
}

std::vector<SkinStroke> LongHairline(const Identity& identity, const MeshBuilder& skin) {
  return LongShape(identity, skin).Hairline();
}

}  // namespace fsm
