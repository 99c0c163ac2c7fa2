// Where the face comes from that the module projects: a file, or another module.

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "fsm/image/image_file.h"
#include "hypermask/live/mask_module.h"

namespace hypermask {
namespace {

bool IsPicture(const std::string& name) {
  constexpr std::string_view kEnds[] = {".png", ".jpg", ".jpeg", ".bmp", ".rgb"};
  return std::ranges::any_of(kEnds, [&](std::string_view end) { return name.ends_with(end); });
}

}  // namespace

vm::Result<void> MaskModule::OpenFace(const std::string& name) {
  if (name == "NONE" || IsPicture(name)) {
    fsm::Image picture;
    if (name != "NONE") {
      auto read = fsm::ReadImage(name);
      if (!read) return std::unexpected(read.error());
      picture = std::move(*read);
    }
    face_film_.reset();
    face_ = std::move(picture);
    if (warp_ && !face_.rgba.empty()) warp_->SetFace(face_);
    return {};
  }
  if (!options_.io) return vm::Fail(vm::Errc::kUnavailable, "there are no films here");
  constexpr double kFolderRate = 25;
  auto source = facetrack::OpenPictures(name, kFolderRate);
  if (!source) return std::unexpected(source.error());
  face_film_ = std::make_unique<LivePictures>(
      *options_.io, std::move(*source), facetrack::IsLive(name),
      LivePictures::Events{.picture =
                               [this](const fsm::Image& picture, LivePictures::Clock::time_point) {
                                 face_ = picture;
                                 if (warp_) warp_->SetFace(face_);
                               },
                           .over =
                               [this](const std::optional<vm::Error>& error) {
                                 if (error) slots_.ReportError("Face", *error);
                               }});
  return {};
}

vm::Result<void> MaskModule::AskFace(const std::string& module) {
  const auto ask = [this](const std::string& to) {
    slots_.Say(vm::To(face_from_, vm::Set("Picture.to", to)));
  };
  if (module != "NONE" && !vm::IsModuleName(module)) {
    return vm::Fail(vm::Errc::kBadValue, "'" + module + "' is not a module's name");
  }
  if (face_from_ != "NONE") ask("NONE");
  face_stream_.reset();
  face_from_ = "NONE";
  if (module == "NONE") return {};
  if (!options_.io) return vm::Fail(vm::Errc::kUnavailable, "there are no sockets here");
  auto stream = FaceStream::Listen(
      *options_.io,
      {.picture =
           [this](const fsm::Image& picture) {
             face_ = picture;
             if (warp_) warp_->SetFace(face_);
           },
       .gone = [this](const vm::Error& error) { slots_.ReportError("Face.from", error); }});
  if (!stream) return std::unexpected(stream.error());
  face_stream_ = std::move(*stream);
  face_from_ = module;
  ask(face_stream_->place());
  return {};
}

}  // namespace hypermask
