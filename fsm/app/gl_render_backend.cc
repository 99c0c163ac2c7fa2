#include "fsm/app/gl_render_backend.h"

#include <algorithm>
#include <future>

#include "fsm/base/notice.h"
#include "fsm/faces/face_folder.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/faces/table_folder.h"
#include "fsm/image/image_file.h"

namespace fsm {
namespace {

/// How things look, in place of fsm/render/tables/appearance.txt: the file of that name in a folder
/// of tables; nothing if there is none. Throws std::runtime_error naming file and line.
std::optional<Appearance> AppearanceIn(const std::string& folder) {
  const auto text = TableIn(folder, kAppearanceFile);
  if (!text) return std::nullopt;
  return Appearance(folder + "/" + kAppearanceFile, *text);
}

}  // namespace

GlRenderBackend::GlRenderBackend(const Options& options)
    : options_(options), appearance_(AppearanceIn(options.tables)) {
  if (options_.where == Options::Where::kHeadless) return;
  try {
    context_ = RenderContext::MakeWindow(options_.width, options_.height, options_.title);
    if (options_.position) context_->Move(options_.position->first, options_.position->second);
  } catch (const std::exception& error) {
    if (options_.where == Options::Where::kWindow) throw;
    Notice("no window (" + std::string(error.what()) + "), drawing headless");
    options_.where = Options::Where::kHeadless;
  }
}

GlRenderBackend::~GlRenderBackend() {
  if (context_) context_->MakeCurrent();
}

const Head& GlRenderBackend::head() {
  if (!head_) head_ = MakeNamedHead(face_);
  return *head_;
}

/// One of Options::more_faces, a built-in head, or one from a photo out of its folder; "" = the
/// first.
std::unique_ptr<Head> GlRenderBackend::MakeNamedHead(const std::string& face) const {
  for (const auto& more : options_.more_faces) {
    if (face.empty() || more.name == face) return more.make();
  }
  return MakeHeadOfName(face.empty() ? Identities().front() : face, options_.tables);
}

void GlRenderBackend::MakeRenderer() {
  if (!context_) {
    context_ = RenderContext::MakeHeadless(options_.width, options_.height, options_.off_screen);
  }
  context_->MakeCurrent();
  if (!renderer_) {
    const Appearance& appearance = appearance_ ? *appearance_ : Appearance::BuiltIn();
    renderer_ = Renderer::Make(*context_, 1, appearance, options_.rig);
    renderer_->SetFormError(appearance.form_error);
  }
}

/// How far springs are from where the head carries them.
std::span<const glm::vec3> GlRenderBackend::Swing(const StateHistory* history) {
  if (history == nullptr || head().rig().data().swing.springs.empty()) {
    simulation_.reset();
    return {};
  }
  if (!simulation_ || simulated_ != head().serial()) {
    simulation_.emplace(head().rig().data().swing.springs);
    simulated_ = head().serial();
  }
  simulation_->RunTo(history->now, history->state_at);
  return simulation_->offsets();
}

vm::Result<void> GlRenderBackend::Draw(const FaceState& state, const Scene& scene,
                                       const StateHistory* history) {
  try {
    // The head is made while the driver starts; both take a good part of the first frame.
    std::future<std::unique_ptr<Head>> made;
    if (!head_ && !renderer_) {
      made = std::async(std::launch::async, [this] { return MakeNamedHead(face_); });
    }
    MakeRenderer();
    if (made.valid()) head_ = made.get();
    Scene seen = scene;
    seen.camera.parallel = head().view();
    renderer_->Draw(head(), state, Swing(history), seen);
    return {};
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kUnavailable, std::string("cannot draw: ") + error.what());
  }
}

const Image& GlRenderBackend::Read() {
  renderer_->Read(image_);
  return image_;
}

std::uint64_t GlRenderBackend::BeginRead() {
  context_->MakeCurrent();
  return renderer_->BeginRead();
}

vm::Result<void> GlRenderBackend::EndRead(std::uint64_t frame, Image& out) {
  try {
    context_->MakeCurrent();
    renderer_->EndRead(frame, out);
    return {};
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kUnavailable, error.what());
  }
}

void GlRenderBackend::DropRead(std::uint64_t frame) {
  context_->MakeCurrent();
  renderer_->DropRead(frame);
}

vm::Result<MouthMeasure> GlRenderBackend::Measure(const FaceState& state) {
  try {
    return head().MeasureMouth(state);
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kUnavailable, std::string("cannot measure: ") + error.what());
  }
}

std::vector<std::string> GlRenderBackend::Faces() const {
  std::vector<std::string> names;
  for (const auto& more : options_.more_faces) names.push_back(more.name);
  for (const std::string& name : Identities()) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  for (const std::string& name : FacesIn(FacesFolder())) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

vm::Result<void> GlRenderBackend::Wear(const std::string& face) {
  const std::vector<std::string> names = Faces();
  if (std::ranges::find(names, face) == names.end()) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : " ") + name;
    return vm::Fail(vm::Errc::kBadValue, "there is no face '" + face + "'; " + list + " expected");
  }
  if (face == (face_.empty() ? names.front() : face_)) return {};
  try {
    head_ = MakeNamedHead(face);
    face_ = face;
    return {};
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kUnavailable, error.what());
  }
}

int GlRenderBackend::width() const { return context_ ? context_->width() : options_.width; }
int GlRenderBackend::height() const { return context_ ? context_->height() : options_.height; }

vm::Result<void> GlRenderBackend::Resize(int width, int height) {
  options_.width = width;
  options_.height = height;
  if (context_) context_->Resize(width, height);
  return {};
}

vm::Result<void> GlRenderBackend::FillScreen(bool fill) {
  if (!has_window()) return RenderBackend::FillScreen(fill);
  context_->SetFullScreen(fill);
  return {};
}

bool GlRenderBackend::has_window() const { return context_ && context_->is_window(); }
void GlRenderBackend::Show() { context_->Present(); }
bool GlRenderBackend::close_requested() const { return context_ && context_->close_requested(); }

vm::Result<void> GlRenderBackend::WritePicture(const Image& image, const std::string& path) {
  return WriteImage(image, path);
}

vm::Result<Image> GlRenderBackend::ReadPicture(const std::string& path) { return ReadImage(path); }

vm::Result<std::unique_ptr<FilmWriter>> GlRenderBackend::OpenFilm(const std::string& path,
                                                                  int width, int height,
                                                                  int frames_per_second) {
  return FilmWriter::Open(path, width, height, frames_per_second);
}

}  // namespace fsm
