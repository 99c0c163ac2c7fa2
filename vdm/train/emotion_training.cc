#include "vdm/train/emotion_training.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "embedded/feelings.h"
#include "sound/sound_file.h"
#include "ssm/engines/espeak_engine.h"
#include "ssm/flite/flite_engine.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vdm/net/word_lines.h"
#include "vdm/prosody/emotion_reader.h"
#include "vdm/train/reading.h"
#include "vm_protocol/core/text_file.h"

namespace vdm {
namespace {

constexpr std::size_t kMaxListBytes = std::size_t{16} << 20;
constexpr std::size_t kPause = 12'800;  // samples of silence between takes: 0.8 s
// How unlike itself the same manner is from one time to another, natural logarithms.
constexpr double kRateVaries = 0.05, kPitchVaries = 0.03, kVolumeVaries = 0.15;

struct FeelingRow {
  std::string name;
  double least = 0, greatest = 0;
  std::size_t times = 0;
  std::string label;
};

vm::Result<std::vector<FeelingRow>> ReadFeelings() {
  WordLines lines("feelings.txt", embedded::feelings());
  std::vector<FeelingRow> rows;
  for (auto words = lines.Next(); !words.empty(); words = lines.Next()) {
    if (words.size() != 5) return lines.Wrong("NAME LEAST GREATEST TIMES CLASS expected");
    std::array<float, 3> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto number = lines.Number(words[i + 1]);
      if (!number) return std::unexpected(number.error());
      numbers[i] = *number;
    }
    if (!ssm::MannerOf(words[0], 100) || numbers[0] < 0 || numbers[1] > 100 || numbers[2] < 0) {
      return lines.Wrong("a manner of ssm, 0 to 100 per cent and a count expected");
    }
    rows.push_back({std::string(words[0]), static_cast<double>(numbers[0]),
                    static_cast<double>(numbers[1]), static_cast<std::size_t>(numbers[2]),
                    std::string(words[4])});
  }
  return rows;
}

vm::Result<std::vector<std::int16_t>> Say(ssm::SpeechEngine& engine, const ssm::SpeechSpan& span) {
  const std::atomic<bool> cancelled{false};
  auto plan = engine.Plan({span}, cancelled);
  if (!plan) return std::unexpected(plan.error());
  ssm::SampleBuffer buffer(ssm::ToFrames(vm::TotalDuration(plan->phonemes)));
  if (auto made = engine.Render(*plan, buffer); !made) return std::unexpected(made.error());
  const auto ready = buffer.Ready();
  return std::vector<std::int16_t>(ready.begin(), ready.end());
}

/// All that is measured of takes with one usual to begin with; the usual afterwards.
class Listener {
 public:
  explicit Listener(const SpeakerUsual& usual)
      : mouth_(ShippedNet(FeatureKind::kMel)), stream_(mouth_.ahead_samples()) {
    stream_.set_usual(usual);
  }
  void Hear(const std::vector<std::int16_t>& samples) {
    std::vector<std::int16_t> sound = samples;
    sound.resize(sound.size() + kPause);
    stream_.Add(sound);
    for (const MouthTracker::Moment& moment : mouth_.Add(sound)) {
      stream_.Advance(moment.sample, 1 - moment.frame.sounds.front(),
                      [&](const ProsodyFrame& frame) {
                        if (auto now = meter_.Add(frame, stream_)) measured_.push_back(*now);
                      });
    }
  }
  const SpeakerUsual& usual() const { return stream_.usual(); }
  const std::vector<Eigen::VectorXd>& measured() const { return measured_; }

 private:
  MouthTracker mouth_;
  ProsodyStream stream_;
  PhraseMeter meter_;
  std::vector<Eigen::VectorXd> measured_;
};

std::vector<std::string> ClassesOf(const std::vector<EmotionTake>& takes) {
  std::set<std::string> labels;
  for (const EmotionTake& take : takes) labels.insert(take.label);
  labels.erase(kNeutral);
  std::vector<std::string> classes = {kNeutral};
  classes.insert(classes.end(), labels.begin(), labels.end());
  return classes;
}

struct OfSpeaker {
  std::string speaker;
  Example example;
};

vm::Result<std::vector<OfSpeaker>> Measure(const std::vector<EmotionTake>& takes) {
  std::map<std::string, SpeakerUsual> usual;
  for (const EmotionTake& take : takes) usual.try_emplace(take.speaker);
  for (auto& [speaker, own] : usual) {
    Listener listener{SpeakerUsual{}};
    for (const EmotionTake& take : takes) {
      if (take.speaker == speaker && take.label == kNeutral) listener.Hear(take.samples);
    }
    if (listener.usual().log_hz.weight() < PhraseMeter::kKnown) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("less than {} s of voice with the label {} found of speaker '{}'",
                                  PhraseMeter::kKnown / 100, kNeutral, speaker));
    }
    own = listener.usual();
  }
  std::vector<OfSpeaker> all;
  for (const EmotionTake& take : takes) {
    Listener listener(usual.at(take.speaker));
    listener.Hear(take.samples);
    for (const Eigen::VectorXd& features : listener.measured()) {
      all.push_back({take.speaker, {take.label, features}});
    }
  }
  return all;
}

/// With each speaker left out in turn: how many of the phrases of a class are taken for which.
std::string LeaveOneOut(const std::vector<OfSpeaker>& all,
                        const std::vector<std::string>& classes) {
  std::set<std::string> speakers;
  for (const OfSpeaker& one : all) speakers.insert(one.speaker);
  if (speakers.size() < 2) return "one speaker: nothing can be said of others";
  std::map<std::pair<std::string, std::string>, std::size_t> counts;
  std::size_t right = 0, count = 0;
  for (const std::string& speaker : speakers) {
    std::vector<Example> others;
    for (const OfSpeaker& one : all) {
      if (one.speaker != speaker) others.push_back(one.example);
    }
    const auto functions = LearnDiscriminant(PhraseMeter::FeatureNames(), classes, others);
    if (!functions) return functions.error().text;
    for (const OfSpeaker& one : all) {
      if (one.speaker != speaker) continue;
      const auto likely = functions->Likelihoods(one.example.features);
      const auto best = static_cast<std::size_t>(std::ranges::max_element(likely) - likely.begin());
      ++counts[{one.example.label, classes[best]}];
      right += classes[best] == one.example.label;
      ++count;
    }
  }
  std::string text =
      fmt::format("speakers left out: {} of {} phrases right ({:.0f} %)", right, count,
                  100.0 * static_cast<double>(right) / static_cast<double>(count));
  for (const auto& [pair, number] : counts) {
    text += fmt::format("; {} as {} {}", pair.first, pair.second, number);
  }
  return text;
}

}  // namespace

vm::Result<std::vector<EmotionTake>> MakeEmotionTakes(
    const std::string& espeak_helper, const std::vector<std::string>& without, Dice dice,
    const std::function<void(const std::string&)>& said) {
  const auto rows = ReadFeelings();
  if (!rows) return std::unexpected(rows.error());
  const auto flite = ssm::MakeFliteEngine();
  std::vector<EmotionTake> takes;
  std::uint64_t index = 0;
  for (const TrainingVoice& voice : BuiltVoices()) {
    Dice chance = dice.For(index++);
    if (std::ranges::any_of(without,
                            [&](const auto& begin) { return voice.name.starts_with(begin); })) {
      continue;
    }
    const bool by_flite = voice.engine == "flite";
    const auto espeak =
        by_flite ? nullptr
                 : ssm::MakeEspeakEngine({.helper = espeak_helper, .variant = voice.variant});
    ssm::SpeechEngine& engine = by_flite ? *flite : *espeak;
    const Reading& reading = BuiltReading(voice.language);
    const Dice texts = chance.For(0);
    std::size_t n = 0;
    for (const FeelingRow& row : *rows) {
      for (std::size_t times = 0; times < row.times; ++times) {
        const auto manner = *ssm::MannerOf(row.name, chance.Between(row.least, row.greatest));
        const double rate = manner.rate * std::exp(kRateVaries * chance.Normal());
        auto samples = Say(
            engine, {.text = reading.Text(n++, texts),
                     .voice = by_flite ? voice.name : "espeak-" + voice.language,
                     .stretch = 1 / rate,
                     .pitch = manner.pitch * std::exp(kPitchVaries * chance.Normal()),
                     .volume = 0.5 * manner.volume * std::exp(kVolumeVaries * chance.Normal())});
        if (!samples) return std::unexpected(samples.error());
        takes.push_back({voice.name, row.label, std::move(*samples)});
      }
    }
    said(fmt::format("{} has spoken {} times", voice.name, n));
  }
  return takes;
}

vm::Result<std::vector<EmotionTake>> ReadEmotionTakes(const std::string& list) {
  const auto text = vm::ReadTextFile(list, kMaxListBytes);
  if (!text) return std::unexpected(text.error());
  const std::filesystem::path folder = std::filesystem::path(list).parent_path();
  WordLines lines(list, *text);
  std::vector<EmotionTake> takes;
  for (auto words = lines.Next(); !words.empty(); words = lines.Next()) {
    if (words.size() != 2 && words.size() != 3) return lines.Wrong("WAV LABEL [SPEAKER] expected");
    auto samples = sound::ReadSound((folder / words[0]).string());
    if (!samples) return lines.Wrong(samples.error().text);
    takes.push_back({words.size() == 3 ? std::string(words[2]) : "somebody", std::string(words[1]),
                     std::move(*samples)});
  }
  if (takes.empty()) return lines.Wrong("no recording found, WAV LABEL [SPEAKER] expected");
  return takes;
}

vm::Result<std::vector<Example>> MeasureTakes(const std::vector<EmotionTake>& takes) {
  const auto all = Measure(takes);
  if (!all) return std::unexpected(all.error());
  std::vector<Example> examples;
  for (const OfSpeaker& one : *all) examples.push_back(one.example);
  return examples;
}

vm::Result<std::string> TeachEmotion(const std::vector<EmotionTake>& takes, const std::string& from,
                                     const std::function<void(const std::string&)>& said) {
  const auto all = Measure(takes);
  if (!all) return std::unexpected(all.error());
  const auto classes = ClassesOf(takes);
  std::vector<Example> examples;
  for (const OfSpeaker& one : *all) examples.push_back(one.example);
  const auto functions = LearnDiscriminant(PhraseMeter::FeatureNames(), classes, examples);
  if (!functions) return std::unexpected(functions.error());
  said(LeaveOneOut(*all, classes));
  return fmt::format(
             "# How somebody speaks beside the usual, by a phrase (docs/vdm.md): pitch in "
             "semitones, range\n"
             "# and rate as natural logarithms of ratios, power and tilt in dB. Learned from {} "
             "phrases of {}.\n",
             examples.size(), from) +
         FormatDiscriminant(*functions);
}

}  // namespace vdm
