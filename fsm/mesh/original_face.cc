#include "fsm/mesh/original_face.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "fsm/image/image_file.h"
#include "fsm/mesh/original_expressions.h"
#include "fsm/mesh/original_points.h"

namespace fsm {
namespace {

constexpr std::size_t kEyeDefBytes = 29 * sizeof(double);

using Offsets = std::vector<std::vector<glm::vec3>>;

/// What the units leave of the expressions, brought to the face's vertices.
vm::Result<Offsets> ReadRests(const PntFile& wireframe, const OriginalSharedFiles& shared) {
  const auto expressions = ReadOriginalExpressions(shared.offsets, shared.standard);
  if (!expressions) return std::unexpected(expressions.error());
  Offsets all;
  for (const PntFile& rest : expressions->rests) {
    std::vector<glm::vec3>& offsets = all.emplace_back();
    for (const PointName& name : wireframe.names) {
      const auto found = rest.index.find(name);
      offsets.push_back(found == rest.index.end() ? glm::vec3(0) : rest.at[found->second]);
    }
  }
  return all;
}

/// The offset files of one folder, over the standard wireframe, brought to the face's vertices.
vm::Result<Offsets> ReadOffsets(const PntFile& wireframe, const std::string& stem,
                                std::size_t count) {
  Offsets all;
  for (std::size_t i = 1; i <= count; ++i) {
    const std::string path = stem + (i < 10 ? "0" : "") + std::to_string(i) + ".pnt";
    const auto file = ReadPnt(path);
    if (!file) return std::unexpected(file.error());
    std::vector<glm::vec3> offsets;
    for (const PointName& name : wireframe.names) {
      const auto found = file->index.find(name);
      if (found == file->index.end()) {
        return vm::Fail(vm::Errc::kBadValue, path + ": point " + std::to_string(name.second) +
                                                 " of group " + std::to_string(name.first) +
                                                 " of the face's wireframe is missing");
      }
      offsets.push_back(file->at[found->second]);
    }
    all.push_back(std::move(offsets));
  }
  return all;
}

template <typename T>
vm::Result<void> Into(vm::Result<T> from, auto& to) {
  if (!from) return std::unexpected(from.error());
  to = std::move(*from);
  return {};
}

vm::Result<void> ReadEyes(const OriginalFaceFiles& files, const OriginalSharedFiles& shared,
                          OriginalFace& face) {
  if (files.eye_picture.empty() || files.eye_def.empty() || shared.eye.empty()) return {};
  if (auto read = Into(ReadImage(files.eye_picture), face.eye_picture); !read) return read;
  const auto bytes = ReadWhole(files.eye_def, 1U << 16);
  if (!bytes) return std::unexpected(bytes.error());
  if (auto read = Into(ParseEyeDef(files.eye_def, *bytes), face.eye_def); !read) return read;
  return Into(ReadObj(shared.eye), face.eye);
}

vm::Result<void> ReadMouth(const OriginalFaceFiles& files, const OriginalSharedFiles& shared,
                           OriginalFace& face) {
  if (!files.teeth_def.empty()) {
    const auto text = ReadWhole(files.teeth_def, 1U << 16);
    if (!text) return std::unexpected(text.error());
    if (auto read = Into(ParseTeethDef(files.teeth_def, *text), face.teeth); !read) return read;
  }
  if (!shared.upper_teeth.empty()) {
    if (auto read = Into(ReadObj(shared.upper_teeth), face.upper_teeth); !read) return read;
  }
  if (!shared.lower_teeth.empty()) {
    if (auto read = Into(ReadObj(shared.lower_teeth), face.lower_teeth); !read) return read;
  }
  if (shared.mouth_picture.empty()) return {};
  const auto wall = ReadImage(shared.mouth_picture);
  if (!wall) return std::unexpected(wall.error());
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i + 3 < wall->rgba.size(); i += 4) {
    sum += glm::dvec3(wall->rgba[i], wall->rgba[i + 1], wall->rgba[i + 2]);
  }
  const glm::vec3 mean(sum / (255.0 * static_cast<double>(wall->rgba.size() / 4)));
  face.mouth = mean * mean;  // near enough to linear light
  return {};
}

/// Little-endian. REQUIRES: eight bytes from `at` on.
double DoubleAt(std::string_view bytes, std::size_t at) {
  std::uint64_t bits = 0;
  for (std::size_t k = 8; k-- > 0;) {
    bits = bits << 8 | static_cast<std::uint8_t>(bytes[at + k]);
  }
  return std::bit_cast<double>(bits);
}

}  // namespace

vm::Result<EyeDef> ParseEyeDef(const std::string& name, std::string_view bytes) {
  if (bytes.size() < kEyeDefBytes) {
    return vm::Fail(vm::Errc::kBadValue, name + ": byte " + std::to_string(bytes.size()) +
                                             ": it ends here, but " + std::to_string(kEyeDefBytes) +
                                             " bytes (29 doubles) are expected");
  }
  EyeDef def;
  // The numbers that are read, by their index; an eye has seven of them in either half of the file.
  std::vector<std::pair<std::size_t, float*>> used{{28, &def.picture_scale}};
  for (std::size_t side = 0; side < 2; ++side) {
    EyeDef::Eye& eye = def.eye[side];
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      used.emplace_back(7 * side + axis, &eye.place[i]);
      used.emplace_back(14 + 7 * side + 3 + axis, &eye.turn_degrees[i]);
    }
    used.emplace_back(7 * side + 6, &eye.scale);
  }
  for (const auto& [index, to] : used) {
    const double number = DoubleAt(bytes, 8 * index);
    if (!std::isfinite(number) || std::abs(number) > 1e4) {
      return vm::Fail(vm::Errc::kBadValue, name + ": byte " + std::to_string(8 * index) +
                                               ": a number within +-10000 expected");
    }
    *to = static_cast<float>(number);
  }
  return def;
}

vm::Result<glm::vec3> ParseTeethDef(const std::string& name, std::string_view text) {
  glm::vec3 colour;
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i) {
    while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
    const auto [end, code] =
        std::from_chars(text.data() + at, text.data() + text.size(), colour[i]);
    if (code != std::errc() || !(colour[i] >= 0 && colour[i] <= 1)) {
      return vm::Fail(vm::Errc::kBadValue,
                      name + ":1: three numbers 0..1, the colour of the teeth, expected");
    }
    at = static_cast<std::size_t>(end - text.data());
  }
  return colour;
}

vm::Result<OriginalFace> ReadOriginalFace(const OriginalFaceFiles& files,
                                          const OriginalSharedFiles& shared) {
  OriginalFace face;
  face.name = files.name;
  for (const auto& read :
       {Into(ReadPnt(files.wireframe), face.wireframe),
        Into(ReadPnt(shared.standard), face.standard), Into(ReadLnk(shared.link), face.link),
        Into(ReadImage(files.picture), face.picture)}) {
    if (!read) return std::unexpected(read.error());
  }
  for (const auto& [file, name] : {std::pair{&face.wireframe, &files.wireframe},
                                   std::pair{&face.standard, &shared.standard}}) {
    if (auto there = CheckPoints(*name, *file); !there) return std::unexpected(there.error());
    for (const auto& triangle : face.link.triangles) {
      for (const PointName& corner : triangle.corner) {
        if (file->index.contains(corner)) continue;
        return vm::Fail(vm::Errc::kBadValue, *name + ": point " + std::to_string(corner.second) +
                                                 " of group " + std::to_string(corner.first) +
                                                 " is missing, which " + shared.link +
                                                 " joins to triangles");
      }
    }
  }
  const auto offsets = [&](const char* stem, std::size_t count) {
    return ReadOffsets(face.wireframe, shared.offsets + "/" + stem, count);
  };
  for (const auto& read : {Into(offsets("_AU_Datas/AU", kOriginalUnits), face.units),
                           Into(offsets("_MU_Datas/MU", kMouthParameters), face.mouth_units),
                           Into(offsets("_VM_Datas/VISEME", kOriginalVisemes), face.visemes),
                           Into(ReadRests(face.wireframe, shared), face.expression_rests),
                           ReadEyes(files, shared, face), ReadMouth(files, shared, face)}) {
    if (!read) return std::unexpected(read.error());
  }
  return face;
}

}  // namespace fsm
