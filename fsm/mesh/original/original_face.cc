#include "fsm/mesh/original/original_face.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "fsm/base/parse_number.h"
#include "fsm/base/words.h"
#include "fsm/image/colour_space.h"
#include "fsm/image/image_file.h"
#include "fsm/mesh/original/original_expressions.h"
#include "fsm/mesh/original/original_points.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

constexpr std::size_t kEyeDefBytes = 29 * sizeof(double);

using Offsets = std::vector<std::vector<glm::vec3>>;

// The readers below throw vm::Failure for a file that cannot be read.

/// Reads the residuals of the expressions, as offsets of the face's vertices.
Offsets ReadResiduals(const PntFile& wireframe, const OriginalSharedFiles& shared) {
  Offsets all;
  const auto read = vm::OrThrow(ReadOriginalExpressions(shared.offsets, shared.standard));
  for (const PntFile& residual : read.residuals) {
    std::vector<glm::vec3>& offsets = all.emplace_back();
    for (const PointName& name : wireframe.names) {
      const auto found = residual.index.find(name);
      offsets.push_back(found == residual.index.end() ? glm::vec3(0)
                                                      : residual.positions[found->second]);
    }
  }
  return all;
}

/// Reads the offset files of one folder, which belong to the standard wireframe, as offsets of the
/// face's vertices.
Offsets ReadOffsets(const PntFile& wireframe, const std::string& stem, std::size_t count) {
  Offsets all;
  for (std::size_t i = 1; i <= count; ++i) {
    const std::string path = stem + (i < 10 ? "0" : "") + std::to_string(i) + ".pnt";
    const PntFile file = vm::OrThrow(ReadPnt(path));
    std::vector<glm::vec3>& offsets = all.emplace_back();
    for (const PointName& name : wireframe.names) {
      const auto found = file.index.find(name);
      if (found == file.index.end()) {
        throw vm::Failure({vm::Errc::kBadValue,
                           path + ": " + InWords(name) + " of the face's wireframe is missing"});
      }
      offsets.push_back(file.positions[found->second]);
    }
  }
  return all;
}

std::string ReadSmall(const std::string& path) {
  return vm::OrThrow(vm::ReadTextFile(path, 1U << 16));
}

void ReadEyes(const OriginalFaceFiles& files, const OriginalSharedFiles& shared,
              OriginalFace& face) {
  if (files.eye_picture.empty() || files.eye_def.empty() || shared.eye.empty()) return;
  face.eye_picture = vm::OrThrow(ReadImage(files.eye_picture));
  face.eye_def = vm::OrThrow(ParseEyeDef(files.eye_def, ReadSmall(files.eye_def)));
  face.eye = vm::OrThrow(ReadObj(shared.eye));
}

void ReadMouth(const OriginalFaceFiles& files, const OriginalSharedFiles& shared,
               OriginalFace& face) {
  if (!files.teeth_def.empty()) {
    face.teeth = vm::OrThrow(ParseTeethDef(files.teeth_def, ReadSmall(files.teeth_def)));
  }
  if (!shared.upper_teeth.empty()) face.upper_teeth = vm::OrThrow(ReadObj(shared.upper_teeth));
  if (!shared.lower_teeth.empty()) face.lower_teeth = vm::OrThrow(ReadObj(shared.lower_teeth));
  if (shared.mouth_picture.empty()) return;
  const Image wall = vm::OrThrow(ReadImage(shared.mouth_picture));
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i + 3 < wall.rgba.size(); i += 4) {
    sum += glm::dvec3(wall.rgba[i], wall.rgba[i + 1], wall.rgba[i + 2]);
  }
  const double pixels = static_cast<double>(wall.rgba.size() / 4);
  face.mouth = SrgbToLinear(glm::vec3(sum / (255.0 * pixels)));
}

/// Checks that every corner of the triangles is a point of the wireframe.
void CheckCorners(const std::string& name, const PntFile& wireframe, const LnkFile& link,
                  const std::string& link_name) {
  for (const auto& triangle : link.triangles) {
    for (const PointName& corner : triangle.corner) {
      if (wireframe.index.contains(corner)) continue;
      throw vm::Failure({vm::Errc::kBadValue, name + ": " + InWords(corner) +
                                                  " is missing, which " + link_name +
                                                  " joins to triangles"});
    }
  }
}

/// Returns a little-endian double. REQUIRES: eight bytes from `at` on.
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
  // The numbers in use, with their index in the file, each half of which has seven for an eye.
  std::vector<std::pair<std::size_t, float*>> used{{28, &def.picture_scale}};
  for (const Side side : kSides) {
    EyeDef::Eye& eye = def.eye[side];
    const std::size_t first = side == Side::kRight ? 0 : 7;
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      used.emplace_back(first + axis, &eye.position[i]);
      used.emplace_back(14 + first + 3 + axis, &eye.rotation_degrees[i]);
    }
    used.emplace_back(first + 6, &eye.scale);
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
  const auto words = WordsOf(ReadUntil("\n", text), 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = i < words.size() ? ParseNumber<float>(words[i]) : std::nullopt;
    if (!number || !(*number >= 0 && *number <= 1)) {
      return vm::Fail(vm::Errc::kBadValue,
                      name + ":1: three numbers 0..1, the colour of the teeth, expected");
    }
    colour[static_cast<int>(i)] = *number;
  }
  return colour;
}

vm::Result<OriginalFace> ReadOriginalFace(const OriginalFaceFiles& files,
                                          const OriginalSharedFiles& shared) try {
  OriginalFace face;
  face.name = files.name;
  face.wireframe = vm::OrThrow(ReadPnt(files.wireframe));
  face.standard = vm::OrThrow(ReadPnt(shared.standard));
  face.link = vm::OrThrow(ReadLnk(shared.link));
  face.picture = vm::OrThrow(ReadImage(files.picture));
  for (const auto& [file, name] : {std::pair{&face.wireframe, &files.wireframe},
                                   std::pair{&face.standard, &shared.standard}}) {
    vm::OrThrow(CheckPoints(*name, *file));
    CheckCorners(*name, *file, face.link, shared.link);
  }
  const auto offsets = [&](const char* stem, std::size_t count) {
    return ReadOffsets(face.wireframe, shared.offsets + "/" + stem, count);
  };
  face.units = offsets("_AU_Datas/AU", kOriginalUnits);
  face.mouth_units = offsets("_MU_Datas/MU", kMouthParameters);
  face.visemes = offsets("_VM_Datas/VISEME", kOriginalVisemes);
  face.expression_residuals = ReadResiduals(face.wireframe, shared);
  ReadEyes(files, shared, face);
  ReadMouth(files, shared, face);
  return face;
} catch (const vm::Failure& failure) {
  return std::unexpected(failure.error);
}

}  // namespace fsm
