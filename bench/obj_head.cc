#include "bench/obj_head.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "fsm/base/box.h"
#include "fsm/head/identity.h"
#include "fsm/head/landmarks.h"
#include "tests/support/still_rig.h"

namespace fsm::bench {
namespace {

constexpr std::size_t kLandmarks = 68;

[[noreturn]] void Damaged(const std::filesystem::path& file, int line) {
  throw std::runtime_error(file.string() + ":" + std::to_string(line) + " cannot be read");
}

/// The distance in the frontal plane from `p` to a chain of points.
float DistanceToChain(const glm::vec3& p, const std::vector<glm::vec3>& chain) {
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const glm::vec2 a(chain[i]), b(chain[i + 1]), q(p);
    const glm::vec2 way = b - a;
    const float t =
        std::clamp(glm::dot(q - a, way) / std::max(glm::dot(way, way), 1e-6F), 0.0F, 1.0F);
    least = std::min(least, glm::length(q - a - t * way));
  }
  return least;
}

bool Inside(const glm::vec3& p, const std::vector<glm::vec3>& outline) {
  bool in = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const glm::vec3 &a = outline[i], &b = outline[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
  }
  return in;
}

class ObjHeadMaker {
 public:
  ObjHeadMaker(const ObjSource& source, const glm::vec3& eyes) {
    Read(source);
    if (balls_.right.empty() || balls_.left.empty()) {
      throw std::runtime_error(source.folder.string() + " has no two eyes");
    }
    const glm::vec3 move = eyes - (balls_.right.centre() + balls_.left.centre()) / 2.0F;
    for (glm::vec3& p : rest_.position) p += move;
    for (Box* const ball : {&balls_.right, &balls_.left}) {
      ball->low += move;
      ball->high += move;
    }
    topology_.albedo.assign(rest_.position.size(), BasePalette().skin);
    ReadLandmarks(source.folder / "landmarks68.txt");
    Assemble();
  }

  HeadAsset Asset() {
    HeadAsset asset{
        .surface = std::move(topology_),
        .rig = support::MakeStillRig(std::move(rest_.position), std::move(rest_.normal)),
        .landmarks = std::move(landmarks_),
        .view = {}};
    for (const Side side : kSides) asset.rig.eyes.centre[side] = balls_[side].centre();
    return asset;
  }

 private:
  void Read(const ObjSource& source) {
    const auto path = source.folder / "neutral.obj";
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path.string() + " cannot be opened");
    std::optional<Material> material;
    int number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      std::istringstream words(line);
      std::string key;
      words >> key;
      if (key == "v") {
        glm::vec3 p;
        if (!(words >> p.x >> p.y >> p.z)) Damaged(path, number);
        rest_.position.push_back(p * source.millimetres);
      } else if (key == "g") {
        words >> key;
        const auto group = source.groups.find(key);
        material = group == source.groups.end() ? std::nullopt : std::optional(group->second);
      } else if (key == "f" && material) {
        AddFace(words, *material, path, number);
      }
    }
  }

  void AddFace(std::istringstream& words, Material material, const std::filesystem::path& path,
               int number) {
    std::vector<std::uint32_t> corners;
    for (std::string word; words >> word;) {
      const int index = std::atoi(word.c_str());
      if (index < 1 || static_cast<std::size_t>(index) > rest_.position.size())
        Damaged(path, number);
      corners.push_back(static_cast<std::uint32_t>(index - 1));
    }
    if (corners.size() < 3) Damaged(path, number);
    if (material == Material::kSclera) {
      for (const auto i : corners) {
        const glm::vec3& p = rest_.position[i];
        balls_[p.x < 0 ? Side::kRight : Side::kLeft].Add(p);
      }
      return;
    }
    auto& indices = batches_[material];
    for (std::size_t k = 2; k < corners.size(); ++k) {
      indices.insert(indices.end(), {corners[0], corners[k - 1], corners[k]});
    }
  }

  void ReadLandmarks(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) return;
    std::vector<glm::vec3> at;
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '#') continue;
      const auto index = static_cast<std::size_t>(std::atol(line.c_str()));
      if (index >= rest_.position.size()) throw std::runtime_error(path.string() + " is damaged");
      at.push_back(rest_.position[index]);
    }
    if (at.size() != kLandmarks) throw std::runtime_error(path.string() + " must have 68 numbers");
    landmarks_["nasion"] = at[27];
    landmarks_["pronasale"] = at[30];
    landmarks_["subnasale"] = at[33];
    landmarks_["stomion"] = (at[62] + at[66]) / 2.0F;
    landmarks_["gnathion"] = at[8];
    // The head has no hair to end at; the usual distance above the nasion.
    landmarks_["trichion"] = at[27] + glm::vec3(0, 63, -12);
    const auto pair = [&](const std::string& name, const glm::vec3& a, const glm::vec3& b) {
      landmarks_[name + "_right"] = a.x < b.x ? a : b;
      landmarks_[name + "_left"] = a.x < b.x ? b : a;
    };
    pair("cheilion", at[48], at[54]);
    pair("endocanthion", at[39], at[42]);
    pair("exocanthion", at[36], at[45]);
    pair("alare", at[31], at[35]);
    pair("zygion", at[1], at[15]);
    for (const Side side : kSides) {
      landmarks_[side == Side::kRight ? "pupil_right" : "pupil_left"] =
          balls_[side].centre() + glm::vec3(0, 0, balls_[side].radii().z);
    }
    Colour(at);
  }

  void Colour(const std::vector<glm::vec3>& at) {
    const auto chain = [&at](std::ptrdiff_t first, std::ptrdiff_t end) {
      return std::vector<glm::vec3>(at.begin() + first, at.begin() + end);
    };
    const auto lips = chain(48, 60);
    const std::array brows = {chain(17, 22), chain(22, 27)};
    const float front = std::min(at[48].z, at[54].z) - 6;
    for (std::size_t i = 0; i < rest_.position.size(); ++i) {
      const glm::vec3& p = rest_.position[i];
      if (p.z < front - 30) continue;
      glm::vec3& colour = topology_.albedo[i];
      if (p.z > front && Inside(p, lips)) colour = BasePalette().lip;
      for (const auto& brow : brows) {
        const float hair = 1 - glm::smoothstep(2.0F, 5.0F, DistanceToChain(p, brow));
        colour = glm::mix(colour, BasePalette().brow, 0.8F * hair);
      }
    }
  }

  void Assemble() {
    const Palette& palette = BasePalette();
    const std::map<Material, glm::vec3> colours = {{Material::kTeeth, palette.tooth},
                                                   {Material::kGum, palette.gum},
                                                   {Material::kTongue, palette.tongue},
                                                   {Material::kMouthInside, palette.mouth}};
    for (const auto& [material, indices] : batches_) {
      const auto colour = colours.find(material);
      if (colour == colours.end()) continue;
      for (const auto i : indices) topology_.albedo[i] = colour->second;
    }
    for (const Side side : kSides) AddEyeball(side);
    for (const auto& [material, indices] : batches_) {
      topology_.parts.push_back({material, static_cast<std::uint32_t>(topology_.indices.size()),
                                 static_cast<std::uint32_t>(indices.size())});
      topology_.indices.insert(topology_.indices.end(), indices.begin(), indices.end());
    }
    topology_.openness.assign(rest_.position.size(), 1);
    for (const glm::vec3& p : rest_.position) topology_.uv.push_back(SkinUv(p));
    rest_.normal.assign(rest_.position.size(), glm::vec3(0));
    for (std::size_t i = 0; i < topology_.indices.size(); i += 3) {
      const std::uint32_t* c = &topology_.indices[i];
      const auto& p = rest_.position;
      const glm::vec3 n = glm::cross(p[c[1]] - p[c[0]], p[c[2]] - p[c[0]]);
      for (int k = 0; k < 3; ++k) rest_.normal[c[k]] += n;
    }
    for (glm::vec3& n : rest_.normal) {
      n = glm::length(n) > 1e-6F ? glm::normalize(n) : glm::vec3(0, 0, 1);
    }
  }

  /// Rings about the line of sight, one of them the edge of the iris.
  void AddEyeball(Side side) {
    constexpr int kSegments = 32, kIrisRings = 4, kRings = 14;
    constexpr float kIrisMm = 5.9F;
    constexpr float kPi = std::numbers::pi_v<float>;
    const glm::vec3 centre = balls_[side].centre(), radii = balls_[side].radii();
    const float edge = std::asin(std::min(kIrisMm / radii.x, 0.9F));
    const auto first = static_cast<std::uint32_t>(rest_.position.size());
    for (int ring = 0; ring <= kRings; ++ring) {
      const float angle = ring <= kIrisRings
                              ? edge * static_cast<float>(ring) / kIrisRings
                              : edge + (0.7F * kPi - edge) * static_cast<float>(ring - kIrisRings) /
                                           (kRings - kIrisRings);
      for (int k = 0; k < kSegments; ++k) {
        const float turn = 2 * kPi * static_cast<float>(k) / kSegments;
        const glm::vec3 out(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                            std::cos(angle));
        rest_.position.push_back(centre + radii * out);
        topology_.albedo.push_back(BasePalette().sclera);
      }
    }
    for (int ring = 0; ring < kRings; ++ring) {
      auto& indices = batches_[ring < kIrisRings ? Material::kIris : Material::kSclera];
      for (std::uint32_t k = 0; k < kSegments; ++k) {
        const auto at = [&](int r, std::uint32_t s) {
          return first + static_cast<std::uint32_t>(r) * kSegments + s % kSegments;
        };
        indices.insert(indices.end(), {at(ring, k), at(ring + 1, k), at(ring + 1, k + 1),
                                       at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
      }
    }
    topology_.eyes[side] = {.ball_radius = radii.x,
                            .iris_radius = kIrisMm,
                            .pupil_radius = 2,
                            .iris_colour = BasePalette().iris};
  }

  HeadSurface topology_;
  HeadVertices rest_;
  std::map<Material, std::vector<std::uint32_t>> batches_;
  Sided<Box> balls_;
  Landmarks landmarks_;
};

}  // namespace

std::unique_ptr<Head> ReadObjHead(const ObjSource& source, const glm::vec3& eyes) {
  return std::make_unique<Head>(ObjHeadMaker(source, eyes).Asset());
}

}  // namespace fsm::bench
