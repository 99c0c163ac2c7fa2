#pragma once

#include <string>

#include "face_editor/core/head_maker.h"

namespace editor {

/// A head from elsewhere (.obj, .glb, .gltf, .vrm) or a face of a configuration of the original
/// (.txt), `face` or else its first one that can be had. Takes up to some seconds; thread: any.
/// Error: kBadValue.
vm::Result<MadeHead> OpenHead(const std::string& path, const std::string& face,
                              const std::string& tables);

}  // namespace editor
