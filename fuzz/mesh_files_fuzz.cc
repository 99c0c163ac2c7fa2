#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "fsm/image/image_codec.h"
#include "fsm/mesh/head_file.h"
#include "fsm/mesh/obj_file.h"
#include "fsm/mesh/original_face.h"
#include "fsm/mesh/pnt_file.h"

/// The first byte chooses the reader. Whatever follows, it must answer; what was read must hold
/// together.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::string why;
  switch (data[0] % 9) {
    case 0:
      if (const auto file = fsm::ParsePnt("f", text)) {
        for (const auto& name : file->names) {
          if (file->index.at(name) >= file->at.size()) __builtin_trap();
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
          if (part.picture >= static_cast<int>(file->pictures.size())) __builtin_trap();
        }
        for (const auto& shape : file->shapes) {
          for (const auto& delta : shape.deltas) {
            if (delta.vertex >= file->position.size()) __builtin_trap();
          }
        }
        // As a head of ours: whatever its places are, it has as many bones and colours.
        const fsm::MeshModel model = fsm::ModelOf(*file, {}, -43);
        if (model.bone.size() != model.position.size()) __builtin_trap();
      }
      break;
    case 7:
      (void)fsm::ParseHeadPoints("f", text);
      break;
    default:
      (void)fsm::DecodeSgi(std::span(data + 1, size - 1), why);
  }
  return 0;
}
