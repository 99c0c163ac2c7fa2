#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/image/image_codec.h"
#include "fsm/mesh/align_imported_head.h"
#include "fsm/mesh/gltf/gltf_head.h"
#include "fsm/mesh/head_points.h"
#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/obj/obj_file.h"
#include "fsm/mesh/original/original_face.h"
#include "fsm/mesh/original/pnt_file.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/rigging/transferred_rig.h"
#include "fsm/rig/reach.h"

namespace {

/// What one run may cost is bounded by what it carries; larger heads are only read.
constexpr std::size_t kMaxCarried = 200;  // vertices, and corners of triangles

/// A face to carry from: the front of a ball, two vertices of it on each lip and lid.
struct Ball {
  std::vector<glm::vec3> place;
  std::vector<std::uint32_t> triangles;
  std::vector<fsm::PointPair> pairs;

  Ball() {
    constexpr std::uint32_t kSide = 9;
    for (std::uint32_t y = 0; y < kSide; ++y) {
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const glm::vec2 flat(20 * (static_cast<float>(x) - 4), 25 * (static_cast<float>(y) - 4));
        place.emplace_back(flat, 100 - 0.004F * (flat.x * flat.x + flat.y * flat.y));
        if (x == 0 || y == 0) continue;
        const std::uint32_t v = y * kSide + x;
        for (const std::uint32_t corner : {v - kSide - 1, v - kSide, v, v - kSide - 1, v, v - 1}) {
          triangles.push_back(corner);
        }
      }
    }
    for (std::size_t v = 0; v < place.size(); v += 5) {
      const auto on = static_cast<fsm::FaceFeature>(v % 5 == 0 ? v / 5 % 5 : 0);
      pairs.push_back({place[v], place[v], on});
    }
  }
};

bool IsFinite(glm::vec3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// The ball as a head whose lower half a mouth parameter pulls down.
std::unique_ptr<fsm::Head> HeadOf(const Ball& ball) {
  fsm::UnriggedHead model;
  fsm::RigData skin = fsm::MakeStillSkin();
  skin.steps = {fsm::RigStep::kChannels};
  fsm::Channel fall;
  fall.drivers = {{{.kind = fsm::Drive::Kind::kMouth, .number = 4}}};
  for (const glm::vec3& p : ball.place) {
    const std::uint32_t v = model.Add(p, fsm::Bone::kSkin, glm::vec3(1));
    if (p.y < 0) fall.moves.push_back({v, glm::vec3(1, -2, 3)});
  }
  skin.channels = {fall};
  model.mesh.BatchOf(fsm::Material::kSkin, -1, false).indices = ball.triangles;
  return fsm::RigUnriggedHead(std::move(model), std::move(skin));
}

/// Makes a head of the file, lays the rig of the ball on it and moves it. Whatever its numbers are,
/// it is refused, or every vertex has a place.
void CarryOnto(const fsm::ImportedHead& file, const fsm::Similarity& place,
               std::span<const fsm::PointPair> pairs) {
  static const std::unique_ptr<fsm::Head> source = HeadOf(Ball());
  try {
    fsm::UnriggedHead model = fsm::AlignImportedHead(file, place, -43);
    if (model.mesh.bone.size() != model.mesh.position.size()) __builtin_trap();
    for (const glm::vec3& p : model.mesh.position) {
      if (!IsFinite(p)) __builtin_trap();
    }
    const auto flesh = model.FleshTriangles(), eyes = model.EyeTriangles();
    if (model.mesh.position.size() > kMaxCarried || flesh.size() + eyes.size() > kMaxCarried)
      return;
    fsm::RigData skin = fsm::TransferRig(model, *source, pairs);
    const auto head = fsm::RigUnriggedHead(std::move(model), std::move(skin));
    fsm::FaceState state;
    state.mouth[fsm::kLowerInnerY] = 3;
    state.au.left[27] = state.au.right[12] = state.seal = state.blink.left = 1;
    fsm::HeadVertices moved;
    head->Evaluate(state, moved);
    for (const glm::vec3& p : moved.position) {
      if (!IsFinite(p)) __builtin_trap();
    }
  } catch (const std::runtime_error&) {
    // It was refused with a sentence.
  }
}

/// A head whose numbers are taken as they come: JSON and base64 keep a fuzzer from most of them.
/// The second byte chooses between numbers up to 128 mm and any floats; after it stand 8 to 23
/// landmarks, their number in the third, then vertices.
void CarryRaw(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2) return;
  const bool floats = bytes[0] % 2 == 1, sewn = bytes[0] % 4 > 1;
  const std::size_t landmarks = 8 + bytes[1] % 16;
  std::size_t at = 2;
  const auto number = [&]() -> float {
    const std::size_t size = floats ? sizeof(float) : sizeof(std::int16_t);
    if (at + size > bytes.size()) return 0;
    float real = 0;
    std::int16_t whole = 0;
    std::memcpy(floats ? static_cast<void*>(&real) : &whole, &bytes[at], size);
    at += size;
    return floats ? real : static_cast<float>(whole) / 256;
  };
  const auto place = [&] {
    const float x = number(), y = number(), z = number();
    return glm::vec3(x, y, z);
  };
  static const Ball ball;
  std::vector<fsm::PointPair> pairs(
      ball.pairs.begin(),
      ball.pairs.begin() +
          std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(landmarks), std::ssize(ball.pairs)));
  for (fsm::PointPair& pair : pairs) pair.to = pair.from + place();
  fsm::ImportedHead file;
  fsm::ImportedHead::Part part;
  while (at < bytes.size() && file.position.size() < kMaxCarried) {
    const glm::vec3 p = place();
    if (!fsm::WithinReach(p)) return;  // no reader lets it through
    part.indices.push_back(static_cast<std::uint32_t>(file.position.size()));
    file.position.push_back(p);
    if (sewn) file.texcoord.emplace_back(0.5F, 0.5F);
    if (part.indices.size() >= 6 && part.indices.size() % 3 == 0) {
      // Beside the triangle the one that joins it to the one before.
      const auto last = static_cast<std::uint32_t>(file.position.size() - 1);
      part.indices.insert(part.indices.end(), {last - 3, last - 2, last - 1});
    }
  }
  part.indices.resize(part.indices.size() / 3 * 3);
  if (part.indices.empty()) return;
  file.parts.push_back(std::move(part));
  CarryOnto(file, {}, pairs);
  if (fsm::WithinReach(pairs[0].to)) CarryOnto(file, fsm::FitSimilarity(pairs), pairs);
}

}  // namespace

/// The first byte chooses the reader. Whatever follows, it must answer; what was read must hold
/// together.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 10) {
    case 0:
      if (const auto file = fsm::ParsePnt("f", text)) {
        for (const auto& name : file->names) {
          if (file->index.at(name) >= file->positions.size()) __builtin_trap();
        }
      }
      break;
    case 1:
      (void)fsm::ParseLnk("f", text);
      break;
    case 2:
      if (const auto file = fsm::ParseObj("f", text)) {
        for (const auto& group : file->groups) {
          for (const auto& t : group.triangles) {
            for (const auto& corner : t) {
              if (corner.position >= file->positions.size()) __builtin_trap();
            }
          }
        }
      }
      break;
    case 3:
      (void)fsm::ParseMtl(text);
      break;
    case 4:
      (void)fsm::ParseEyeDef("f", text);
      break;
    case 5:
      (void)fsm::ParseTeethDef("f", text);
      break;
    case 6:
      if (const auto file = fsm::ParseGltfHead("f", text)) {
        for (const auto& part : file->parts) {
          for (const auto v : part.indices) {
            if (v >= file->position.size()) __builtin_trap();
          }
          if (part.base_colour >= static_cast<int>(file->base_colours.size())) __builtin_trap();
        }
        for (const auto& shape : file->shapes) {
          for (const auto& delta : shape.moves) {
            if (delta.vertex >= file->position.size()) __builtin_trap();
          }
        }
        for (const auto& p : file->position) {
          if (!fsm::WithinReach(p)) __builtin_trap();
        }
        CarryOnto(*file, {}, Ball().pairs);
      }
      break;
    case 7:
      if (const auto points = fsm::ParseHeadPoints("f", text)) {
        const Ball ball;
        fsm::ImportedHead file;
        file.position = ball.place;
        file.parts.push_back({.name = "", .indices = ball.triangles});
        CarryOnto(file, fsm::FitSimilarity(points->pairs), points->pairs);
      }
      break;
    case 8:
      (void)fsm::DecodeSgi(std::span(data + 1, size - 1));
      break;
    default:
      CarryRaw(std::span(data + 1, size - 1));
  }
  return 0;
}
