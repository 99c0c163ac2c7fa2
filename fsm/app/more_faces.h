#pragma once

#include <string>
#include <vector>

#include "fsm/app/gl_render_backend.h"
#include "fsm/app/original_config.h"

namespace fsm {

/// The faces of a configuration of the original. A face whose files are not there is left out with
/// a notice, in `left_out` or else on stderr. `tables`: folder of tables that replace the built-in
/// ones.
std::vector<GlRenderBackend::Options::MoreFace> FacesOf(
    const OriginalConfig& config, const std::string& tables,
    std::vector<std::string>* left_out = nullptr);

/// Takes the looks of the expressions from the files beside the configuration's standard wireframe
/// (AU31.pnt ..., user*.pnt, userdef*.pnt), so that FaceExp shows them on every face. Where they
/// cannot be read ours stay, and a sentence says so: in `notices`, else on stderr.
void TakeExpressions(OriginalConfig& config, std::vector<std::string>* notices = nullptr);

}  // namespace fsm
