#include "vdm/train/head_lesson.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <sstream>

#include "fsm/motion/speech/speech_gestures.h"
#include "sound/sound_file.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vdm/prosody/head_inputs.h"
#include "vdm/prosody/head_mover.h"
#include "vdm/prosody/prosody_stream.h"
#include "vm_protocol/core/text_file.h"

namespace vdm {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{256} << 20;
constexpr double kLongestGapMs = 200;

std::unexpected<vm::Error> Wrong(const std::string& name, std::size_t line,
                                 const std::string& what) {
  return vm::Fail(vm::Errc::kBadValue, fmt::format("{}:{}: {}", name, line, what));
}

/// The motion of one recording.
struct Course {
  std::vector<double> ms;
  std::vector<HeadPose> poses;

  HeadPose At(double at) const {
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(ms, at) - ms.begin());
    if (next == 0) return poses.front();
    if (next == ms.size()) return poses.back();
    const auto u = static_cast<float>((at - ms[next - 1]) / (ms[next] - ms[next - 1]));
    HeadPose out = poses[next - 1];
    for (std::size_t i = 0; i < 3; ++i) {
      out.angles[i] += u * (poses[next].angles[i] - out.angles[i]);
    }
    out.brow += u * (poses[next].brow - out.brow);
    return out;
  }
  bool Known(double at) const {
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(ms, at) - ms.begin());
    return next != 0 && next != ms.size() && ms[next] - ms[next - 1] <= kLongestGapMs;
  }
};

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != ' ' && c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

/// The columns of a course; the brow is the mean of those after the angles.
const std::vector<std::string_view> kCourse{"ms", "down", "right", "tilt", "brow"},
    kFilmCourse{"ms", "down", "right", "tilt", "au1R", "au1L", "au2R", "au2L"};

/// The way the head is mostly held becomes zero.
void CentreOnMedian(Course& course) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<float> angles;
    for (const HeadPose& pose : course.poses) angles.push_back(pose.angles[i]);
    const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
    std::ranges::nth_element(angles, middle);
    for (HeadPose& pose : course.poses) pose.angles[i] -= *middle;
  }
}

vm::Result<Course> ReadCourse(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxFileBytes);
  if (!text) return std::unexpected(text.error());
  std::istringstream lines(*text);
  std::string line;
  std::getline(lines, line);
  const auto names = Cells(line);
  const bool of_film =
      std::ranges::count(names, "brow") == 0 && std::ranges::count(names, "au1R") > 0;
  const auto& expected = of_film ? kFilmCourse : kCourse;
  std::vector<std::size_t> columns;
  for (const std::string_view name : expected) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
      return Wrong(
          path, 1,
          fmt::format("no column '{}' found, {} expected", name, fmt::join(expected, " ")));
    }
    columns.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  Course course;
  for (std::size_t number = 2; std::getline(lines, line); ++number) {
    const auto cells = Cells(line);
    if (cells == std::vector<std::string>{""}) continue;
    const auto cell = [&](std::size_t i) {
      return columns[i] < cells.size() ? cells[columns[i]] : "";
    };
    if (of_film && cell(1).empty() && !cell(0).empty()) continue;
    std::vector<double> values;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double most = i == 0 ? 1e8 : i >= 4 ? 2 : 90;
      std::size_t used = 0;
      try {
        values.push_back(std::stod(cell(i), &used));
      } catch (const std::exception&) {
        used = 0;
      }
      if (used != cell(i).size() || used == 0 || !(std::abs(values[i]) <= most)) {
        return Wrong(path, number,
                     fmt::format("'{}' found for {}, a number within +-{} expected",
                                 cell(i).substr(0, 40), expected[i], most));
      }
    }
    if (!course.ms.empty() && values[0] <= course.ms.back()) {
      return Wrong(path, number,
                   fmt::format("{} ms found after {} ms", values[0], course.ms.back()));
    }
    course.ms.push_back(values[0]);
    HeadPose pose;
    for (std::size_t i = 0; i < 3; ++i) pose.angles[i] = static_cast<float>(values[1 + i]);
    pose.brow = static_cast<float>(std::accumulate(values.begin() + 4, values.end(), 0.0) /
                                   static_cast<double>(values.size() - 4));
    course.poses.push_back(pose);
  }
  if (course.ms.size() < 2) return Wrong(path, 1, "fewer than two instants found");
  if (of_film) CentreOnMedian(course);
  return course;
}

}  // namespace

HeadLesson MakeHeadLesson(std::string who, const std::vector<std::int16_t>& samples, float emotion,
                          std::size_t sounds, double late_ms, const HeadTruth& truth) {
  MouthTracker mouth(ShippedNet(FeatureKind::kMel));
  ProsodyStream prosody(mouth.ahead_samples());
  HeadInputs inputs(sounds);
  std::vector<std::int16_t> sound = samples;
  sound.resize(sound.size() + mouth.ahead_samples() + mouth.hop_samples());
  prosody.Add(sound);
  const auto moments = mouth.Add(sound);
  const auto count = static_cast<Eigen::Index>(moments.size());
  HeadLesson lesson{
      .who = std::move(who),
      .inputs = Eigen::MatrixXf(static_cast<Eigen::Index>(HeadNet::Inputs(sounds)), count),
      .truth = Eigen::MatrixXf(static_cast<Eigen::Index>(HeadNet::kOutputs), count),
      .phrase = std::vector<std::uint64_t>(moments.size())};
  for (Eigen::Index k = 0; k < count; ++k) {
    const MouthTracker::Moment& moment = moments[static_cast<std::size_t>(k)];
    prosody.Advance(moment.sample, 1 - moment.frame.sounds.front(), [&](const ProsodyFrame& frame) {
      inputs.Add(frame, prosody.usual(), prosody.phrases(), moment.frame.sounds);
    });
    lesson.inputs.col(k) = inputs.Vector(emotion);
    const HeadPose pose = truth(static_cast<double>(moment.sample) / 16 - late_ms);
    lesson.truth.col(k) << pose.angles[0], pose.angles[1], pose.angles[2], pose.brow;
    const bool moves = prosody.phrases().pause() <= HeadMover::kRest;
    lesson.phrase[static_cast<std::size_t>(k)] = moves ? prosody.phrases().phrase() : 0;
  }
  return lesson;
}

std::vector<Talk> TalksOf(const std::vector<Take>& takes, std::size_t sentences, Dice dice) {
  std::vector<Talk> talks;
  std::size_t in_last = sentences;
  for (std::size_t n = 0; n < takes.size(); ++n) {
    const Take& take = takes[n];
    if (in_last == sentences || talks.back().voice != take.voice) {
      if (!talks.empty() && in_last < sentences) talks.pop_back();
      talks.push_back({.voice = take.voice, .samples = {}, .phonemes = {}});
      in_last = 0;
    }
    Talk& talk = talks.back();
    const auto pause_ms = std::chrono::milliseconds(
        static_cast<int>(dice.Between(dice.Chance(0.6) ? 150 : 500, 1500)));
    talk.samples.resize(talk.samples.size() + static_cast<std::size_t>(pause_ms.count()) * 16);
    talk.phonemes.push_back({"pau", pause_ms});
    talk.samples.insert(talk.samples.end(), take.samples.begin(), take.samples.end());
    talk.phonemes.insert(talk.phonemes.end(), take.phonemes.begin(), take.phonemes.end());
    ++in_last;
  }
  if (!talks.empty() && in_last < sentences) talks.pop_back();
  for (Talk& talk : talks) talk.samples.resize(talk.samples.size() + 16000);
  return talks;
}

HeadTruth TextDrivenHead(const Talk& talk, float emotion, const fsm::MotionTables& tables,
                         std::uint64_t seed) {
  const fsm::AutoSpeech& calm = tables.motions.auto_speeches.at(0);
  const fsm::AutoSpeech& lively = tables.motions.auto_speeches.at(1);
  const auto size = [&](double fsm::AutoSpeech::*part) {
    return calm.*part + static_cast<double>(emotion) * (lively.*part - calm.*part);
  };
  const std::array<double, 4> sizes = {size(&fsm::AutoSpeech::nod), size(&fsm::AutoSpeech::turn),
                                       size(&fsm::AutoSpeech::tilt), size(&fsm::AutoSpeech::brow)};
  const fsm::SpeechGestures gestures(fsm::MakeVisemeTargets(talk.phonemes, tables, fsm::LipStyle{}),
                                     tables.gestures, seed);
  return [gestures, sizes](double ms) {
    const auto at = gestures.HeadAt(ms);
    return HeadPose{{static_cast<float>(sizes[0] * at.nod), static_cast<float>(sizes[1] * at.turn),
                     static_cast<float>(sizes[2] * at.tilt)},
                    static_cast<float>(sizes[3] * at.brow)};
  };
}

vm::Result<std::vector<HeadLesson>> ReadHeadLessons(const std::string& list, std::size_t sounds,
                                                    double late_ms) {
  const auto text = vm::ReadTextFile(list, kMaxFileBytes);
  if (!text) return std::unexpected(text.error());
  const std::filesystem::path folder = std::filesystem::path(list).parent_path();
  std::vector<HeadLesson> lessons;
  std::istringstream lines(*text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string wav, csv, emotion = "0", more;
    if (!(words >> wav) || wav.starts_with('#')) continue;
    words >> csv >> emotion >> more;
    char* end = nullptr;
    const float factor = std::strtof(emotion.c_str(), &end);
    if (csv.empty() || !more.empty() || *end != '\0' || !(factor >= 0 && factor <= 1)) {
      return Wrong(list, number, "WAV CSV [EMOTION, 0 to 1] expected");
    }
    const auto samples = sound::ReadSound((folder / wav).string());
    if (!samples) return std::unexpected(samples.error());
    const auto course = ReadCourse((folder / csv).string());
    if (!course) return std::unexpected(course.error());
    HeadLesson lesson = MakeHeadLesson(wav, *samples, factor, sounds, late_ms,
                                       [&](double ms) { return course->At(ms); });
    for (std::size_t k = 0; k < lesson.phrase.size(); ++k) {
      if (!course->Known(static_cast<double>(k) * 10 - late_ms)) lesson.phrase[k] = 0;
    }
    lessons.push_back(std::move(lesson));
  }
  if (lessons.empty()) return Wrong(list, 1, "no recording found, WAV CSV [EMOTION] expected");
  return lessons;
}

}  // namespace vdm
