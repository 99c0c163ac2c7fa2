#include "fsm/mesh/rigging/transferred_rig.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <utility>

#include "fsm/head/identity.h"

namespace fsm {
namespace {

std::vector<std::uint32_t> TrianglesOf(const HeadSurface& surface,
                                       std::initializer_list<Material> materials) {
  std::vector<std::uint32_t> out;
  for (const auto& part : surface.parts) {
    if (std::ranges::find(materials, part.material) == materials.end()) continue;
    const auto corners = surface.Corners(part);
    out.insert(out.end(), corners.begin(), corners.end());
  }
  return out;
}

using Row = DeformationTransfer::Row;

/// Resamples the rig of one head on the vertices of another: each vertex gets the attributes of the
/// source point that it follows.
class RigResampler {
 public:
  /// `rows`: one for each target vertex. Lifetime: all arguments outlive this.
  RigResampler(const RigData& source, std::span<const Row> rows, RigData& rig)
      : source_(source), rows_(rows), rig_(rig) {}

  /// Resamples the data of all steps except the seam of the lips, which has other vertices.
  void Resample(std::span<const glm::vec3> rest) {
    rig_.weights.resize(rows_.size(), Still());
    rig_.proxy.rest.assign(rest.begin(), rest.end());
    for (std::size_t v = 0; v < rows_.size(); ++v) ResampleVertex(v);
    ResampleMouthChannels();
    ResampleLids();
    ResampleFollowers();
    ResampleContacts();
  }

 private:
  static SkinWeights Still() {
    SkinWeights weights;
    weights.free = 0;
    return weights;
  }

  /// Returns, by source vertex, its element in `all`; null for most.
  template <typename T>
  std::vector<const T*> ByVertex(const std::vector<T>& all) const {
    std::vector<const T*> by(source_.rest.size(), nullptr);
    for (const T& one : all) by[one.vertex] = &one;
    return by;
  }

  void ResampleVertex(std::size_t v) {
    float sum = 0;
    for (const auto& [from, share] : rows_[v]) sum += share;
    if (sum <= 0) return;
    SkinWeights& mean = rig_.weights[v];
    glm::vec3 place(0);
    mean.above_mouth = 0;
    for (const auto& [from, share] : rows_[v]) {
      const SkinWeights& one = source_.weights[from];
      place += share / sum * source_.rest[from];
      mean.domain += share / sum * one.domain;
      mean.above_mouth += share / sum * one.above_mouth;
      mean.jaw += share * one.jaw;
      mean.free += share * one.free;
    }
    rig_.proxy.rest[v] = place;
  }

  void ResampleMouthChannels() {
    constexpr float kMin = 1e-3f;  // millimetres
    std::vector<glm::vec3> by(source_.rest.size());
    for (const Channel& channel : source_.channels) {
      if (!channel.IsLedBy(Drive::Kind::kMouth)) continue;
      std::ranges::fill(by, glm::vec3(0));
      for (const Displacement& d : channel.moves) by[d.vertex] = d.offset;
      Channel& own = rig_.channels.emplace_back(channel);
      own.moves.clear();
      for (std::uint32_t v = 0; v < rows_.size(); ++v) {
        glm::vec3 sum(0);
        for (const auto& [from, share] : rows_[v]) sum += share * by[from];
        if (glm::length(sum) > kMin) own.moves.push_back({v, sum});
      }
    }
  }

  void ResampleLids() {
    rig_.lids = {.vertices = {},
                 .eyes = source_.lids.eyes,
                 .ball = source_.lids.ball,
                 .cornea_centre = source_.lids.cornea_centre};
    const auto lids = ByVertex(source_.lids.vertices);
    for (std::uint32_t v = 0; v < rows_.size(); ++v) {
      LidRig::Vertex mean{.vertex = v};
      float sum = 0, left = 0, lid_share = 0;
      for (const auto& [from, share] : rows_[v]) sum += lids[from] ? share : 0;
      if (sum <= 0) continue;
      for (const auto& [from, share] : rows_[v]) {
        const LidRig::Vertex* one = lids[from];
        if (!one) continue;
        const float of_lids = share / sum;
        mean.point.upper += share * one->point.upper;
        mean.point.lower += share * one->point.lower;
        mean.point.upper_angle += of_lids * one->point.upper_angle;
        mean.point.lower_angle += of_lids * one->point.lower_angle;
        mean.point.meet_angle += of_lids * one->point.meet_angle;
        mean.point.opening += of_lids * one->point.opening;
        mean.point.y += of_lids * one->point.y;
        mean.point.z += of_lids * one->point.z;
        left += one->side == Side::kLeft ? of_lids : 0;
        lid_share += one->is_lid ? share : 0;
      }
      mean.side = left > 0.5f ? Side::kLeft : Side::kRight;
      mean.is_lid = lid_share > 0.5f;
      rig_.lids.vertices.push_back(mean);
    }
  }

  void ResampleFollowers() {
    std::map<std::uint32_t, std::vector<LipRig::Follower>> followers;
    for (const LipRig::Follower& f : source_.lips.followers) followers[f.vertex].push_back(f);
    for (std::uint32_t v = 0; v < rows_.size(); ++v) {
      // By pair of the seam, and whether of the upper lip.
      std::map<std::pair<std::uint32_t, bool>, float> held;
      for (const auto& [from, share] : rows_[v]) {
        const auto found = followers.find(from);
        if (found == followers.end()) continue;
        for (const auto& f : found->second) held[{f.pair, f.hold > 0}] += share * f.hold;
      }
      for (const auto& [of, sum] : held) rig_.lips.followers.push_back({v, of.first, sum});
    }
  }

  void ResampleContacts() {
    rig_.teeth.upper = source_.teeth.upper;
    rig_.teeth.lower = source_.teeth.lower;
    const auto contacts = ByVertex(source_.teeth.contacts);
    for (std::uint32_t v = 0; v < rows_.size(); ++v) {
      float sum = 0, upper = 0, lower = 0;
      for (const auto& [from, share] : rows_[v]) {
        if (!contacts[from]) continue;
        sum += share;
        upper += share * contacts[from]->upper_gap;
        lower += share * contacts[from]->lower_gap;
      }
      if (sum > 0.5f) rig_.teeth.contacts.push_back({v, upper / sum, lower / sum});
    }
  }

  const RigData& source_;
  std::span<const Row> rows_;
  RigData& rig_;
};

/// Adds the source's lips to the model as vertices that are not drawn, by which crossing lips are
/// detected. Returns the rows of all vertices.
std::vector<Row> AddLips(const RigData& source, std::span<const Row> rows, UnriggedHead& model) {
  std::vector<Row> all(rows.begin(), rows.end());
  std::map<std::uint32_t, std::uint32_t> known;
  const auto own = [&](std::uint32_t v) {
    const auto [at, fresh] = known.try_emplace(v, 0);
    if (fresh) {
      at->second = model.Add(source.rest[v], Bone::kSkin, glm::vec3(0));
      all.push_back({{v, 1.0f}});
    }
    return at->second;
  };
  for (const auto& [upper, lower] : source.mouth.seam) {
    const std::uint32_t own_upper = own(upper);
    model.mouth.seam.emplace_back(own_upper, own(lower));
  }
  if (const auto& corners = source.mouth.corners) {
    const std::uint32_t own_left = own(corners->left);
    model.mouth.corners = {own(corners->right), own_left};
  }
  return all;
}

/// Colours the lips, and their inside, of a head without pictures: as red relative to its skin as
/// those of the source.
void ColourLips(const Head& source, std::span<const Row> rows, UnriggedHead& model) {
  if (model.textures.base_colour) return;
  const HeadSurface& surface = source.surface();
  std::vector<bool> lip(surface.albedo.size(), false);
  for (const std::uint32_t v : TrianglesOf(surface, {Material::kLip, Material::kMouthInside})) {
    lip[v] = true;
  }
  const glm::vec3 skin = BasePalette().skin;
  for (std::size_t v = 0; v < rows.size(); ++v) {
    glm::vec3 red(0);
    float sum = 0;
    for (const auto& [from, share] : rows[v]) {
      if (!lip[from]) continue;
      red += share * surface.albedo[from] / skin;
      sum += share;
    }
    if (sum > 0) model.mesh.albedo[v] *= red + glm::vec3(1 - std::min(sum, 1.0f));
  }
}

/// Returns the offset of each vertex from its position by the rig at rest to that in the file.
std::vector<glm::vec3> OwnForm(const RigData& rig, const UnriggedHead& model,
                               std::span<const Row> rows) {
  RigData proxy = rig;
  proxy.rest = rig.proxy.rest;
  proxy.proxy.rest.clear();
  proxy.rest_normal.assign(proxy.rest.size(), glm::vec3(0, 0, 1));
  proxy.bone = model.mesh.bone;
  proxy.mouth = model.mouth;
  HeadVertices still;
  Rig(std::move(proxy)).Evaluate({}, still);
  std::vector<glm::vec3> form(rows.size(), glm::vec3(0));
  for (std::size_t v = 0; v < rows.size(); ++v) {
    if (!rows[v].empty()) form[v] = model.mesh.position[v] - still.position[v];
  }
  return form;
}

/// Moves the undrawn lips to the head's lips; the vertices of a pair stay together.
void MoveLips(const UnriggedHead& model, std::span<const PointPair> pairs,
              std::vector<glm::vec3>& form) {
  const auto displacement = [&](glm::vec3 at) {
    constexpr float kNear = 3;  // millimetres
    glm::vec3 sum(0);
    float weight = 1e-9f;
    for (const PointPair& pair : pairs) {
      if (pair.feature != FaceFeature::kUpperLip && pair.feature != FaceFeature::kLowerLip)
        continue;
      const float distance = glm::distance(pair.from, at) / kNear;
      const float one = std::exp(-distance * distance);
      sum += one * (pair.to - pair.from);
      weight += one;
    }
    return sum / weight;
  };
  for (const auto& [upper, lower] : model.mouth.seam) {
    form[upper] = form[lower] =
        displacement(0.5f * (model.mesh.position[upper] + model.mesh.position[lower]));
  }
  if (!model.mouth.corners) return;
  for (const std::uint32_t corner : model.mouth.corners->InOrder())
    form[corner] = displacement(model.mesh.position[corner]);
}

DeformationTransfer TransferBetween(const Head& source, const UnriggedHead& model,
                                    std::span<const PointPair> pairs) {
  HeadVertices rest;
  source.Evaluate({}, rest);
  try {
    return {
        {rest.position, SkinTriangles(source.surface()), false, EyeballTriangles(source.surface())},
        {model.mesh.position, model.FleshTriangles(), model.has_uv_seams, model.EyeTriangles()},
        pairs};
  } catch (const std::runtime_error& error) {
    if (model.name.empty()) throw;
    throw std::runtime_error(model.name + ": " + error.what());
  }
}

}  // namespace

std::vector<std::uint32_t> SkinTriangles(const HeadSurface& surface) {
  return TrianglesOf(surface, {Material::kSkin, Material::kLip, Material::kMouthInside});
}

std::vector<std::uint32_t> EyeballTriangles(const HeadSurface& surface) {
  return TrianglesOf(surface, {Material::kSclera, Material::kIris, Material::kPupil});
}

RigData TransferRig(UnriggedHead& model, const Head& source, std::span<const PointPair> pairs) {
  using enum RigStep;
  const RigData& from = source.rig().data();
  const DeformationTransfer transfer = TransferBetween(source, model, pairs);
  RigData rig;
  const std::vector<Row> rows = AddLips(from, transfer.rows(), model);
  rig.lips.apart_at_rest = from.lips.apart_at_rest;
  RigResampler(from, rows, rig).Resample(model.mesh.position);
  rig.units = from.units;
  rig.asymmetry_seed = from.asymmetry_seed;
  rig.has_unit_channels = true;
  std::ranges::move(UnitChannels(rig.units, model.mesh.bone, rig.weights),
                    std::back_inserter(rig.channels));
  rig.steps = {kChannels, kLids, kJaw, kTeeth, kLips, kTeeth};  // twice, as in make_head.cc
  rig.proxy.to_own = OwnForm(rig, model, rows);
  MoveLips(model, pairs, rig.proxy.to_own);
  ColourLips(source, rows, model);
  rig.steps.push_back(kOwnForm);
  return rig;
}

}  // namespace fsm
