#include "fsm/app/gl_face_view.h"

#include <future>

#include "fsm/base/catch_errors.h"
#include "fsm/faces/table_names.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

/// Reads the folder's appearance.txt, which replaces fsm/render/tables/appearance.txt; nothing if
/// it has none. Throws std::runtime_error naming file and line.
std::optional<Appearance> AppearanceIn(const TableFolder& folder) {
  const auto own = vm::OrThrow(folder.Find(kAppearanceTable));
  if (!own) return std::nullopt;
  return Appearance(own->path, own->text);
}

}  // namespace

GlFaceView::GlFaceView(HeadLibrary& library, const Options& options)
    : library_(library), options_(options), appearance_(AppearanceIn(options.tables)) {
  if (options_.window_mode == Options::WindowMode::kHeadless) return;
  try {
    context_ = RenderContext::MakeWindow(options_.width, options_.height, options_.title);
    if (options_.position) context_->Move(options_.position->first, options_.position->second);
  } catch (const std::exception& error) {
    if (options_.window_mode == Options::WindowMode::kWindow) throw;
    options_.log("notice: no window (" + std::string(error.what()) + "), drawing headless");
  }
}

GlFaceView::~GlFaceView() {
  if (context_) context_->MakeCurrent();
}

void GlFaceView::MakeRenderer() {
  if (!context_) {
    context_ = RenderContext::MakeHeadless(options_.width, options_.height, options_.off_screen);
  }
  context_->MakeCurrent();
  if (!renderer_) {
    const Appearance& appearance = appearance_ ? *appearance_ : Appearance::BuiltIn();
    renderer_ = Renderer::Make(*context_, 1, appearance, options_.rig);
    renderer_->SetMaxErrorPixels(appearance.form_error);
  }
}

/// Simulates the springs and returns their offsets (Simulation::offsets).
std::span<const glm::vec3> GlFaceView::SpringOffsets(const Head& head,
                                                     const StateHistory* history) {
  if (history == nullptr || head.rig().data().spring_rig.springs.empty()) {
    simulation_.reset();
    return {};
  }
  if (!simulation_ || simulated_ != head.serial()) {
    simulation_.emplace(head.rig().data().spring_rig.springs);
    simulated_ = head.serial();
  }
  simulation_->RunTo(history->now, history->state_at);
  return simulation_->offsets();
}

vm::Result<void> GlFaceView::Draw(const FaceState& state, const Scene& scene,
                                  const StateHistory* history) {
  return CatchErrors("cannot draw: ", [&] {
    // Make the head while the graphics driver starts, since both take long.
    std::future<void> made;
    if (!renderer_) {
      made = std::async(std::launch::async, [this] { static_cast<void>(library_.head()); });
    }
    MakeRenderer();
    if (made.valid()) made.get();
    const Head& head = library_.head();
    renderer_->Draw(head, state, SpringOffsets(head, history), scene);
  });
}

const Image& GlFaceView::Read() {
  renderer_->Read(image_);
  return image_;
}

std::uint64_t GlFaceView::BeginRead() {
  context_->MakeCurrent();
  return renderer_->BeginRead();
}

vm::Result<void> GlFaceView::EndRead(std::uint64_t frame, Image& out) {
  return CatchErrors("", [&] {
    context_->MakeCurrent();
    renderer_->EndRead(frame, out);
  });
}

void GlFaceView::DropRead(std::uint64_t frame) {
  context_->MakeCurrent();
  renderer_->DropRead(frame);
}

vm::Result<void> GlFaceView::Resize(int width, int height) {
  options_.width = width;
  options_.height = height;
  if (context_) context_->Resize(width, height);
  return {};
}

}  // namespace fsm
