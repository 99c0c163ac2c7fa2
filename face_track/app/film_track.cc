#include "face_track/app/film_track.h"

#include <fmt/format.h>

#include <cstdio>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_track/film/picture_source.h"
#include "face_track/follow/unit_lesson.h"
#include "face_track/print/progress.h"
#include "face_track/print/track_plot.h"
#include "fsm/base/table_reader.h"
#include "vm_protocol/core/or_throw.h"

namespace facetrack {
namespace {

/// Where lines go: a file, made with the first of them, or standard output.
class Out {
 public:
  Out(std::string path, bool at_once) : path_(std::move(path)), at_once_(at_once) {}
  ~Out() { Close(); }
  Out(const Out&) = delete;
  void Write(const std::string& text) {
    if (!file_) file_ = path_.empty() ? stdout : std::fopen(path_.c_str(), "w");
    if (!file_ || std::fwrite(text.data(), 1, text.size(), file_) != text.size() ||
        (at_once_ && std::fflush(file_) != 0)) {
      Fail();
    }
  }
  void Finish() {
    if (file_ && !Close()) Fail();
  }

 private:
  bool Close() {
    std::FILE* file = std::exchange(file_, nullptr);
    return !file || (file == stdout ? std::fflush(file) : std::fclose(file)) == 0;
  }
  [[noreturn]] void Fail() const {
    throw std::runtime_error("the track cannot be written to " +
                             (path_.empty() ? "standard output" : "'" + path_ + "'"));
  }
  const std::string path_;
  const bool at_once_;
  std::FILE* file_ = nullptr;
};

}  // namespace

SeenFace FaceToFollow(const std::string& person) {
  const SeenFace& usual = SeenFace::Shipped();
  if (person.empty()) return usual;
  const std::string text = vm::OrThrow(fsm::ReadTableFile(person));
  return FaceOfPerson(usual, vm::OrThrow(ParseShownUnits(person, text, usual)));
}

void PrintFilmTrack(const FilmTrack& wanted) {
  // First of all: a misspelt name is no matter of networks.
  const auto source = vm::OrThrow(OpenPictures(wanted.film, wanted.rate));
  const SeenFace face = FaceToFollow(wanted.person);
  std::optional<UnitLesson> lesson;
  if (!wanted.lesson.empty()) {
    const std::string prompts = vm::OrThrow(fsm::ReadTableFile(wanted.lesson));
    lesson = vm::OrThrow(UnitLesson::Parse(wanted.lesson, prompts, face));
  }
  auto networks = vm::OrThrow(facefit::FaceNetworks::Load(wanted.networks));
  auto attention = vm::OrThrow(facefit::AttentionNetwork::Load(wanted.networks));
  Tracker tracker(networks, attention, face, wanted.tracker);
  const FacePrint print(wanted.format, wanted.extras, face);
  TrackPlot plot;
  Out out(wanted.out, IsLive(wanted.film));
  std::size_t pictures = 0, faces = 0;
  const auto write = [&](const std::vector<FaceLine>& lines) {
    for (const FaceLine& line : lines) {
      faces += line.person != 0 ? 1 : 0;
      if (lesson)
        lesson->Add(line);
      else
        out.Write(print.Line(line));
      if (!wanted.plot.empty()) plot.Add(line);
    }
  };
  TimedPicture picture;
  vm::Result<bool> more = false;
  {
    Progress progress("face_track:", wanted.quiet, source->length_ms());
    while ((more = source->Next(picture)) && *more) {
      if (pictures == 0 && !lesson) out.Write(print.Header());
      write(tracker.Look(picture.picture, picture.ms));
      progress.At(++pictures, picture.ms);
    }
  }
  write(tracker.Finish());
  if (lesson && faces > 0 && more) {
    const UnitLesson::Learned learned = vm::OrThrow(lesson->Finish());
    for (const std::string& sentence : learned.left_out)
      std::cerr << "face_track: " << sentence << '\n';
    if (learned.shown.empty()) throw std::runtime_error("no unit was shown");
    out.Write(PrintShownUnits(learned.shown));
  }
  out.Finish();
  if (!wanted.plot.empty() && faces > 0) vm::OrThrow(plot.Write(wanted.plot));
  if (!more) throw std::runtime_error(more.error().text);
  if (faces == 0) {
    throw std::runtime_error(
        fmt::format("'{}': no face is seen in any of its {} pictures", wanted.film, pictures));
  }
  if (!wanted.quiet) {
    std::cerr << fmt::format("face_track: a face in {} of {} pictures\n", faces, pictures);
  }
}

}  // namespace facetrack
