#include "hypermask/live/face_source.h"

#include <algorithm>
#include <utility>

#include "fsm/image/image_file.h"

namespace hypermask {
namespace {

bool IsPicture(const std::string& name) {
  constexpr std::string_view kEnds[] = {".png", ".jpg", ".jpeg", ".bmp", ".rgb"};
  return std::ranges::any_of(kEnds, [&](std::string_view end) { return name.ends_with(end); });
}

}  // namespace

void FaceSource::DeclareSlots() {
  slots_.Declare({.name = "Face",
                  .grammar = "NONE | <file>",
                  .initial = "NONE",
                  .help = "The face that is projected: a picture (.png, .jpg, .bmp, .rgb), or a "
                          "film, once.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (auto opened = Open(value.text); !opened) {
                      return std::unexpected(opened.error());
                    }
                    return value.text;
                  }});
  slots_.Declare({.name = "Face.from",
                  .grammar = "NONE | <word>",
                  .initial = "NONE",
                  .help =
                      "The module whose pictures are projected, as FSM: it is asked for them by "
                      "its slot Picture.to.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (auto asked = AskModule(value.word(0)); !asked) {
                      return std::unexpected(asked.error());
                    }
                    return from_;
                  },
                  .saved = false});
}

void FaceSource::Close() {
  stream_.reset();
  film_.reset();
}

void FaceSource::Take(const fsm::Image& picture) {
  picture_ = picture;
  changed_(picture_);
}

vm::Result<void> FaceSource::Open(const std::string& name) {
  return name == "NONE" || IsPicture(name) ? OpenPicture(name) : OpenFilm(name);
}

vm::Result<void> FaceSource::OpenPicture(const std::string& name) {
  fsm::Image picture;
  if (name != "NONE") {
    auto read = fsm::ReadImage(name);
    if (!read) return std::unexpected(read.error());
    picture = std::move(*read);
  }
  film_.reset();
  Take(picture);
  return {};
}

vm::Result<void> FaceSource::OpenFilm(const std::string& name) {
  if (!io_) return vm::Fail(vm::Errc::kUnavailable, "there are no films here");
  constexpr double kFolderRate = 25;
  auto source = facetrack::OpenPictures(name, kFolderRate);
  if (!source) return std::unexpected(source.error());
  film_ = std::make_unique<LivePictures>(
      *io_, std::move(*source), facetrack::IsLive(name),
      LivePictures::Events{.picture = [this](const fsm::Image& picture,
                                             LivePictures::Clock::time_point) { Take(picture); },
                           .over =
                               [this](const std::optional<vm::Error>& error) {
                                 if (error) slots_.ReportError("Face", *error);
                               }});
  return {};
}

vm::Result<void> FaceSource::AskModule(const std::string& module) {
  const auto ask = [this](const std::string& to) {
    slots_.Say(vm::To(from_, vm::Set("Picture.to", to)));
  };
  if (module != "NONE" && !vm::IsModuleName(module)) {
    return vm::Fail(vm::Errc::kBadValue, "'" + module + "' is not a module's name");
  }
  if (from_ != "NONE") ask("NONE");
  stream_.reset();
  from_ = "NONE";
  if (module == "NONE") return {};
  if (!io_) return vm::Fail(vm::Errc::kUnavailable, "there are no sockets here");
  auto stream = FaceStream::Listen(
      *io_, {.picture = [this](const fsm::Image& picture) { Take(picture); },
             .gone = [this](const vm::Error& error) { slots_.ReportError("Face.from", error); }});
  if (!stream) return std::unexpected(stream.error());
  stream_ = std::move(*stream);
  from_ = module;
  ask(stream_->place());
  return {};
}

}  // namespace hypermask
