#include "film_dub/follow/film_course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "face_track/film/picture_source.h"
#include "film_dub/follow/grain.h"

namespace filmdub {
namespace {

constexpr std::size_t kGrainEach = 5;  // pictures
constexpr float kSure = 0.5F;          // that there is a face
constexpr float kMostMissMm = 4;       // of its points
constexpr float kOpenJaw = 1.5F;       // how much a degree of it counts beside one of the head
constexpr float kShutLids = 20;        // likewise lids that are shut

}  // namespace

std::vector<double> FilmCourse::Times() const {
  std::vector<double> times;
  for (const auto& line : lines) times.push_back(line.ms);
  return times;
}

bool FilmCourse::IsUsable(std::size_t picture) const {
  const auto& line = lines[picture];
  return line.person != 0 && line.certainty >= kSure && line.miss <= kMostMissMm &&
         std::hypot(line.head[fsm::kDown], line.head[fsm::kToRight]) <= kMostTurn;
}

std::optional<std::size_t> FilmCourse::RestPicture() const {
  std::optional<std::size_t> best;
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!IsUsable(i)) continue;
    const auto& line = lines[i];
    const float lids = std::max(0.0F, 1 - std::min(line.lid[0], line.lid[1]));
    const float cost = std::hypot(line.head[fsm::kDown], line.head[fsm::kToRight]) +
                       0.5F * std::abs(line.head[fsm::kTilted]) + kOpenJaw * line.jaw +
                       kShutLids * lids;
    if (cost >= least) continue;
    least = cost;
    best = i;
  }
  return best;
}

fsm::Angles FilmCourse::Turned(const fsm::Angles& held, std::size_t from,
                               std::size_t picture) const {
  fsm::Angles turn = held;
  for (std::size_t k = 0; k < turn.size(); ++k)
    turn[k] += lines[picture].head[k] - lines[from].head[k];
  return turn;
}

vm::Result<FilmCourse> Survey(const std::string& film, facefit::FaceNetworks& networks,
                              facefit::AttentionNetwork& attention,
                              const facetrack::Tracker::Settings& settings,
                              const std::function<void(std::size_t, double)>& told) {
  auto source = facetrack::OpenPictures(film, 25, facetrack::kWholeSide);
  if (!source) return std::unexpected(source.error());
  facetrack::Tracker tracker(networks, attention, facetrack::SeenFace::Shipped(), settings);
  FilmCourse course;
  const auto take = [&](std::vector<facetrack::FaceLine> lines) {
    for (auto& line : lines) {
      line.points = {};  // most of a line's memory, and not needed here
      course.lines.push_back(std::move(line));
    }
  };
  facetrack::TimedPicture picture;
  fsm::Image before;
  facefit::Box2 face{.low = {0, 0}, .high = {0, 0}};  // where it was seen last
  std::vector<double> grains;
  std::size_t pictures = 0;
  vm::Result<bool> more = false;
  while ((more = (*source)->Next(picture)) && *more) {
    if (++pictures > kMostPictures) {
      return vm::Fail(vm::Errc::kLimit,
                      fmt::format("'{}' has more than {} pictures", film, kMostPictures));
    }
    course.width = picture.picture.width;
    course.height = picture.picture.height;
    take(tracker.Look(picture.picture, picture.ms));
    if (!course.lines.empty() && !course.lines.back().places.empty()) {
      face = {};
      for (const glm::vec2 place : course.lines.back().places) face.Add(place);
    }
    if (pictures % kGrainEach == 0) grains.push_back(GrainBetween(before, picture.picture, face));
    if ((pictures + 1) % kGrainEach == 0) before = picture.picture;
    told(pictures, picture.ms);
  }
  if (!more) return std::unexpected(more.error());
  take(tracker.Finish());
  if (!grains.empty()) {
    const auto middle = grains.begin() + static_cast<std::ptrdiff_t>(grains.size() / 2);
    std::ranges::nth_element(grains, middle);
    course.grain = *middle;
  }
  if (pictures < 2) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("'{}' is a single picture, a film expected", film));
  }
  if (std::ranges::none_of(course.lines, [](const auto& line) { return line.person != 0; })) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("'{}': no face is seen in any of its {} pictures", film, pictures));
  }
  return course;
}

std::string Stretches(const FilmCourse& course, const std::function<bool(std::size_t)>& is) {
  std::string text;
  for (std::size_t i = 0; i < course.lines.size(); ++i) {
    if (!is(i)) continue;
    std::size_t last = i;
    while (last + 1 < course.lines.size() && is(last + 1)) ++last;
    const double from = course.lines[i].ms / 1000, to = course.lines[last].ms / 1000;
    text += text.empty() ? "" : ", ";
    text += last == i ? fmt::format("{:.2f} s", from) : fmt::format("{:.2f} to {:.2f} s", from, to);
    i = last;
  }
  return text;
}

}  // namespace filmdub
