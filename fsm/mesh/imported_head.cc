#include "fsm/mesh/imported_head.h"

#include <algorithm>
#include <filesystem>

#include "fsm/mesh/gltf/gltf_head.h"
#include "fsm/mesh/obj/obj_head.h"
#include "vm_protocol/core/lower_case.h"

namespace fsm {
std::optional<std::string> FileBeside(const std::string& path, const std::string& name) {
  const std::filesystem::path given(name);
  if (name.empty() || given.is_absolute() || std::ranges::find(given, "..") != given.end()) {
    return std::nullopt;
  }
  return (std::filesystem::path(path).parent_path() / given).string();
}

std::string PlainShapeName(std::string_view name) {
  std::string out = vm::LowerCase(name);
  if (const auto dot = out.find_last_of(".:"); dot != std::string::npos && dot + 2 < out.size()) {
    out = out.substr(dot + 1);  // node.shape, namespace:shape
  }
  for (const auto& [end, word] : {std::pair("_l", "left"), std::pair("_r", "right")}) {
    if (out.ends_with(end)) out = out.substr(0, out.size() - 2) + word;
  }
  std::erase_if(out, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return out;
}

vm::Result<ImportedHead> ReadImportedHead(const std::string& path) {
  const std::string ending = vm::LowerCase(std::filesystem::path(path).extension().string());
  if (ending == ".obj") return ReadObjHead(path);
  if (ending == ".glb" || ending == ".gltf" || ending == ".vrm") return ReadGltfHead(path);
  return vm::Fail(vm::Errc::kBadValue,
                  "'" + path + "' is no head's name: it must end in .obj, .glb, .gltf or .vrm");
}

}  // namespace fsm
