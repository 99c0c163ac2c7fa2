#include "film_dub/app/dub.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_track/film/picture_source.h"
#include "face_track/print/progress.h"
#include "film_dub/face/dub_face.h"
#include "film_dub/follow/film_course.h"
#include "film_dub/paint/mouth_painter.h"
#include "film_dub/timing/dub_timing.h"
#include "fsm/film/film_writer.h"
#include "ssm/engines/wav_piece.h"
#include "vm_protocol/core/file_kind.h"
#include "vm_protocol/core/or_throw.h"

namespace filmdub {
namespace {

constexpr int kComes = 3;  // pictures within which the new mouth comes and goes

/// The picture of that number, read from the beginning.
fsm::Image PictureOf(const std::string& film, std::size_t number) {
  const auto source = vm::OrThrow(facetrack::OpenPictures(film, 25, facetrack::kWholeSide));
  facetrack::TimedPicture picture;
  for (std::size_t i = 0; i <= number; ++i) {
    if (!vm::OrThrow(source->Next(picture))) {
      throw std::runtime_error("'" + film + "' has changed while it was looked at");
    }
  }
  return std::move(picture.picture);
}

/// Where the head is laid in each picture; none where it cannot be.
std::vector<std::optional<Placing>> Places(const FilmCourse& course, std::size_t rest,
                                           DubFace& face) {
  std::vector<std::optional<Placing>> places(course.lines.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!course.IsUsable(i)) continue;
    fsm::FaceState state;
    state.head_rotation = course.Turned(face.held(), rest, i);
    face.Pose(state);
    places[i] = PlaceOnFilm(face.Points(), course.lines[i].places);
  }
  return Smoothed(places);
}

/// How much of the new mouth each picture shows: less beside pictures that show none of it.
std::vector<float> SharesOf(const std::vector<std::optional<Placing>>& places) {
  std::vector<float> shares(places.size(), 1);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i]) continue;
    for (int away = -kComes; away <= kComes; ++away) {
      const auto k = static_cast<std::ptrdiff_t>(i) + away;
      if (k < 0 || k >= std::ssize(shares)) continue;
      auto& share = shares[static_cast<std::size_t>(k)];
      share = std::min(share, static_cast<float>(std::abs(away)) / (kComes + 1));
    }
  }
  return shares;
}

class Writing {
 public:
  Writing(const Dub& wanted, const FilmCourse& course, std::size_t rest, DubFace& face,
          const NewSpeech& speech)
      : wanted_(wanted),
        course_(course),
        rest_(rest),
        face_(face),
        speech_(speech),
        places_(Places(course, rest, face)),
        shares_(SharesOf(places_)) {}

  void Run(double rate, const std::vector<std::size_t>& shown) {
    const auto movie = vm::OrThrow(
        fsm::FilmWriter::Open(wanted_.out, course_.width, course_.height, rate, kAltered));
    const auto source =
        vm::OrThrow(facetrack::OpenPictures(wanted_.film, 25, facetrack::kWholeSide));
    facetrack::Progress progress("film_dub: written", wanted_.quiet, speech_.length_s * 1000);
    facetrack::TimedPicture picture;
    std::size_t read = 0;  // how many pictures of the film
    for (std::size_t i = 0; i < shown.size(); ++i) {
      for (; read <= shown[i]; ++read) {
        if (!vm::OrThrow(source->Next(picture))) {
          throw std::runtime_error("'" + wanted_.film + "' has changed while it was looked at");
        }
      }
      const double at_s = static_cast<double>(i) / rate;
      fsm::Image out = picture.picture;
      Paint(out, shown[i], vm::Time(std::llround(at_s * 1e6)));
      vm::OrThrow(movie->Add(out));
      progress.At(i + 1, at_s * 1000);
    }
    vm::OrThrow(movie->Finish(speech_.sound_file));
  }

 private:
  void Paint(fsm::Image& out, std::size_t number, vm::Time at) {
    if (!places_[number]) return;
    fsm::FaceState state = speech_.motion->StateAt(at);
    state.au = {};
    state.blink = {};
    state.gaze = {};
    state.head_forward_mm = 0;
    state.head_rotation = course_.Turned(face_.held(), rest_, number);
    face_.Pose(state);
    PaintMouth(out, course_.lines[number].places,
               {.picture = &face_.Draw(),
                .placing = *places_[number],
                .points = face_.Points(),
                .grain = course_.grain,
                .seed = static_cast<std::uint64_t>(at.count()) + 1},
               shares_[number]);
  }

  const Dub& wanted_;
  const FilmCourse& course_;
  const std::size_t rest_;
  DubFace& face_;
  const NewSpeech& speech_;
  const std::vector<std::optional<Placing>> places_;
  const std::vector<float> shares_;
};

}  // namespace

void MakeDub(const Dub& wanted) {
  const auto tell = [&](const std::string& text) {
    if (!wanted.quiet) std::cerr << "film_dub: " << text << std::endl;
  };
  if (wanted.film == "-" || facetrack::IsLive(wanted.film)) {
    throw std::runtime_error("'" + wanted.film +
                             "' can be seen only once: a film or a folder of pictures expected");
  }
  for (const std::string& read : {wanted.film, wanted.speech.sound}) {
    std::error_code none;
    if (!read.empty() && !std::filesystem::exists(read, none)) {
      throw std::runtime_error("there is no '" + read + "'");
    }
  }
  vm::OrThrow(fsm::FilmWriter::CheckName(wanted.out));
  vm::OrThrow(vm::CheckWritable(wanted.out));
  for (const std::string& read : {wanted.film, wanted.speech.sound}) {
    std::error_code none;  // there may be no such file yet
    if (std::filesystem::equivalent(read, wanted.out, none)) {
      throw std::runtime_error("'" + wanted.out +
                               "' would be overwritten, though it is read: another name expected");
    }
  }
  auto networks = vm::OrThrow(facefit::FaceNetworks::Load(wanted.networks));
  auto attention = vm::OrThrow(facefit::AttentionNetwork::Load(wanted.networks));
  const ssm::TemporaryFolder folder;
  const NewSpeech speech = vm::OrThrow(Prepare(wanted.speech, folder.File("spoken.wav")));
  tell(fmt::format("the new words last {:.2f} s", speech.length_s));

  std::optional<FilmCourse> course;
  {
    facetrack::Progress progress("film_dub: followed", wanted.quiet, std::nullopt);
    course =
        vm::OrThrow(Survey(wanted.film, networks, attention, wanted.tracker,
                           [&](std::size_t pictures, double ms) { progress.At(pictures, ms); }));
  }
  const auto times = course->Times();
  const double rate = PicturesPerSecond(times);
  const auto shown = vm::OrThrow(FitLength(times, rate, speech.length_s));
  const auto rest = course->RestPicture();
  if (!rest) {
    throw std::runtime_error(fmt::format(
        "'{}': its face is never turned to the camera; expected within {:g} degrees of it",
        wanted.film, kMostTurn));
  }
  tell(fmt::format("the face is taken from the picture at {:.2f} s", times[*rest] / 1000));
  const auto face = vm::OrThrow(
      DubFace::Make(networks, PictureOf(wanted.film, *rest), course->lines[*rest].places));
  Writing(wanted, *course, *rest, *face, speech).Run(rate, shown);
  const std::string as_it_was =
      Stretches(*course, [&](std::size_t i) { return !course->IsUsable(i); });
  if (!as_it_was.empty()) {
    std::cerr << "film_dub: notice: the mouth is the old one at " << as_it_was
              << " of the film: no face, or one turned by more than "
              << fmt::format("{:g} degrees\n", kMostTurn);
  }
}

}  // namespace filmdub
