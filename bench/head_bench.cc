// How near a head moved by a voice comes to one moved by the text: for voices of a training
// (--takes), and for the people of Debian's pocketsphinx-testdata (phonemes by our aligner, with
// the text). The truth of both is what the face does itself, Autonomous SPEECH.
//   vdm_head_bench NET --takes FILE --voices rms,british-f3

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>

#include "sound/sound_file.h"
#include "srm/align/phone_aligner.h"
#include "vdm/train/distortion.h"
#include "vdm/train/head_score.h"

namespace {

constexpr const char* kPeople = "/usr/share/pocketsphinx/test/data/";
constexpr std::uint64_t kSeed = 77;

/// With a Delay of 100 ms and so much more, which makes up for what the head is late.
std::size_t early_hops = 0;

double work_s = 0, sound_s = 0;  // of mouth, prosody and head together

std::vector<vdm::HeadPose> Heard(const vdm::HeadNet& net,
                                 const std::vector<std::int16_t>& samples) {
  const std::clock_t start = std::clock();
  auto poses = vdm::HeadOf(net, samples, 0);
  work_s += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  sound_s += static_cast<double>(samples.size()) / 16000;
  poses.erase(poses.begin(),
              poses.begin() + static_cast<std::ptrdiff_t>(std::min(early_hops, poses.size())));
  return poses;
}

template <typename T>
T OrThrow(vm::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  return std::move(*result);
}

std::vector<vdm::HeadPose> Sampled(const vdm::HeadTruth& truth, std::size_t count) {
  std::vector<vdm::HeadPose> poses;
  for (std::size_t k = 0; k < count; ++k) poses.push_back(truth(10.0 * static_cast<double>(k)));
  return poses;
}

void Print(const std::string& who, const vdm::HeadScore& score) {
  int best = 0;
  for (int late = -200; late <= 300; late += 10) {
    if (score.correlation(0, late) > score.correlation(0, best)) best = late;
  }
  std::cout << fmt::format(
      "| {} | {:.2f} ({:.2f} at {:+} ms) | {:.2f} | {:.0f} % of {} | {:.0f} % of {} | {:.0f} % | "
      "{:+.0f} |",
      who, score.correlation(0, 0), score.correlation(0, best), best, score.correlation(3, best),
      100 * score.found(), score.true_beats(), 100 * score.right(), score.our_beats(),
      100 * score.by_chance(), score.late_ms());
  for (std::size_t i = 0; i < 3; ++i) {
    std::cout << fmt::format(" {:.1f} / {:.1f} deg, {:.1f} / {:.1f} deg/s |", score.range(i, false),
                             score.range(i, true), score.speed(i, false), score.speed(i, true));
  }
  std::cout << fmt::format(" {:.2f} / {:.2f} |\n", score.range(3, false), score.range(3, true));
}

void TestVoices(const vdm::HeadNet& net, const fsm::MotionTables& tables, const std::string& path,
                const std::vector<std::string>& voices) {
  std::vector<vdm::Take> takes = OrThrow(vdm::LoadCorpus(path));
  std::erase_if(takes, [&](const vdm::Take& take) {
    return std::ranges::find(voices, take.voice) == voices.end();
  });
  std::map<std::string, vdm::HeadScore> scores;
  std::uint64_t n = 0;
  for (const vdm::Talk& talk : vdm::TalksOf(takes, 6, vdm::Dice(kSeed))) {
    const auto ours = Heard(net, talk.samples);
    const auto truth = Sampled(vdm::TextDrivenHead(talk, 0, tables, kSeed + n++), ours.size());
    for (vdm::HeadScore* score : {&scores[talk.voice], &scores["~ all of these voices"]}) {
      score->Add(ours, truth);
    }
  }
  for (const auto& [voice, score] : scores) Print(voice, score);
}

/// "<s> TEXT </s> (NAME)" of each line.
std::vector<std::pair<std::string, std::string>> Transcription(const std::string& path) {
  std::vector<std::pair<std::string, std::string>> texts;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t begin = line.find("<s>"), end = line.find("</s>"), open = line.find('(');
    if (open == std::string::npos || begin == std::string::npos || end == std::string::npos) {
      continue;
    }
    texts.emplace_back(line.substr(open + 1, line.find(')') - open - 1),
                       line.substr(begin + 3, end - begin - 3));
  }
  return texts;
}

void TestPeople(const vdm::HeadNet& net, const fsm::MotionTables& tables) {
  auto aligner = vm::Result<std::unique_ptr<srm::PhoneAligner>>(
      srm::PhoneAligner::Open(srm::PocketsphinxOptions().model));
  if (!aligner) {
    std::cerr << "vdm_head_bench: no people: " << aligner.error().text << std::endl;
    return;
  }
  for (const auto& [folder, file] :
       {std::pair("librivox/", "transcription"), std::pair("cards/", "cards.transcription")}) {
    vdm::HeadScore score;
    std::uint64_t n = 0;
    for (const auto& [name, text] : Transcription(std::string(kPeople) + folder + file)) {
      const auto samples = OrThrow(sound::ReadSound(kPeople + std::string(folder) + name + ".wav"));
      const auto aligned = (*aligner)->Align(samples, text);
      if (!aligned) {
        std::cerr << "vdm_head_bench: " << name << ": " << aligned.error().text << std::endl;
        continue;
      }
      const vdm::Talk talk{.voice = name, .samples = samples, .phonemes = aligned->phonemes};
      const auto ours = Heard(net, samples);
      score.Add(ours, Sampled(vdm::TextDrivenHead(talk, 0, tables, kSeed + n++), ours.size()));
    }
    if (score.true_beats() > 0) Print(std::string("people, ") + folder, score);
  }
}

/// Noise, music and silence: how far the head goes, and whether anything is said of an emotion.
void TestNoSpeech(const vdm::HeadNet& net) {
  std::size_t moved = 0, sounds = 0, instants = 0, all = 0;
  float widest = 0;
  for (std::uint64_t n = 0; n < 100; ++n, ++sounds) {
    std::size_t now = 0;
    for (const vdm::HeadPose& pose : Heard(net, vdm::NoSpeech(vdm::Dice(0xBE4C).For(n)))) {
      float most = 0;
      for (const float angle : pose.angles) most = std::max(most, std::abs(angle));
      widest = std::max(widest, most);
      now += most > 0.1F;
      ++all;
    }
    instants += now;
    moved += now > 0;
  }
  std::cout << fmt::format(
      "\n{} sounds of noise, music and silence: the head is off by more than 0.1 degrees {:.2f} % "
      "of "
      "the time, in {} of them, by {:.2f} degrees at most\n",
      sounds, 100.0 * static_cast<double>(instants) / static_cast<double>(all), moved, widest);
}

}  // namespace

int main(int argc, char** argv) {
  std::string net, takes;
  std::vector<std::string> voices;
  CLI::App app("How near a head moved by a voice comes to one moved by the text");
  app.add_option("net", net, "A network of heads")->required();
  app.add_option("--takes", takes, "Speech of a training (the file takes of vdm_train --work)");
  app.add_option("--voices", voices, "Which of its voices")->delimiter(',');
  app.add_option("--early", early_hops, "Hops of 10 ms that Delay is longer than 100 ms");
  CLI11_PARSE(app, argc, argv);
  try {
    std::ifstream file(net);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const vdm::HeadNet head = OrThrow(vdm::ParseHeadNet(net, text));
    const fsm::MotionTables tables = OrThrow(fsm::MotionTables::Load());
    std::cout
        << "| voice | r of the nod (at best) | r of the brow | beats found | beats right | by "
           "chance | late ms | down, ours / truth | right | tilt | brow |\n"
           "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    if (!takes.empty()) TestVoices(head, tables, takes, voices);
    TestPeople(head, tables);
    TestNoSpeech(head);
    std::cout << fmt::format("real-time factor of mouth and head {:.4f}\n", work_s / sound_s);
  } catch (const std::exception& error) {
    std::cerr << "vdm_head_bench: " << error.what() << std::endl;
    return 1;
  }
}
