// How near `align` comes to the times the synthesiser itself gives, and beside Rhubarb Lip Sync on
// the same files where its program is on the path. Prints a table:  alignment_bench [VOICE...]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "bench/speech_material.h"
#include "srm/align/phone_aligner.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/flite/flite_engine.h"
#include "ssm/voice/wav_file.h"

namespace {

using speech_bench::Speech;

struct Interval {
  double start = 0, end = 0;  // ms
  std::string name{};
};

std::vector<Interval> Intervals(const vm::PhonemeList& phonemes) {
  std::vector<Interval> list;
  double at = 0;
  for (const vm::Phoneme& phoneme : phonemes) {
    const auto ms = static_cast<double>(phoneme.duration.count());
    list.push_back({at, at + ms, phoneme.name == "ax" ? "ah" : phoneme.name});
    at += ms;
  }
  return list;
}

bool IsClosure(const std::string& name) { return name == "p" || name == "b" || name == "m"; }

/// Which of `ours` stands for which of `theirs`, by least edits; -1 = none.
std::vector<int> Partners(const std::vector<Interval>& theirs, const std::vector<Interval>& ours) {
  const std::size_t n = theirs.size(), m = ours.size();
  std::vector<int> table((n + 1) * (m + 1));
  const auto cost = [&](std::size_t i, std::size_t j) -> int& { return table[i * (m + 1) + j]; };
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t j = 0; j <= m; ++j) {
      if (i == 0 || j == 0) {
        cost(i, j) = static_cast<int>(i + j);
      } else {
        const int same = cost(i - 1, j - 1) + (theirs[i - 1].name == ours[j - 1].name ? 0 : 1);
        cost(i, j) = std::min({same, cost(i - 1, j) + 1, cost(i, j - 1) + 1});
      }
    }
  }
  std::vector<int> partner(n, -1);
  for (std::size_t i = n, j = m; i > 0 && j > 0;) {
    const bool same = theirs[i - 1].name == ours[j - 1].name;
    if (cost(i, j) == cost(i - 1, j - 1) + (same ? 0 : 1)) {
      if (same) partner[i - 1] = static_cast<int>(j - 1);
      --i, --j;
    } else if (cost(i, j) == cost(i - 1, j) + 1) {
      --i;
    } else {
      --j;
    }
  }
  return partner;
}

struct Closures {
  int hit = 0, all = 0;
  double error_sum = 0;  // ms, of the beginning of the nearest closed mouth
  /// A closure is hit if the mouth is closed in the middle of it.
  void Add(const std::vector<Interval>& theirs, const std::vector<Interval>& closed) {
    for (const Interval& truth : theirs) {
      if (!IsClosure(truth.name)) continue;
      ++all;
      const double middle = (truth.start + truth.end) / 2;
      double nearest = 1000;
      bool hit_it = false;
      for (const Interval& one : closed) {
        hit_it = hit_it || (one.start <= middle && middle < one.end);
        nearest = std::min(nearest, std::abs(one.start - truth.start));
      }
      hit += hit_it;
      error_sum += nearest;
    }
  }
};

struct Figures {
  std::vector<double> errors;  // of boundaries whose phonemes on both sides agree
  double bias = 0, sound_s = 0, work_s = 0;
  std::size_t boundaries = 0;  // the truth's
  Closures closures;
  std::map<std::string, int> far;  // boundaries off by more than 50 ms, by their phonemes

  void Add(const std::vector<Interval>& theirs, const std::vector<Interval>& ours) {
    const std::vector<int> partner = Partners(theirs, ours);
    boundaries += theirs.size() - 1;
    for (std::size_t i = 0; i + 1 < theirs.size(); ++i) {
      if (partner[i] < 0 || partner[i + 1] != partner[i] + 1) continue;
      const double error = ours[static_cast<std::size_t>(partner[i])].end - theirs[i].end;
      errors.push_back(std::abs(error));
      bias += error;
      if (std::abs(error) > 50)
        ++far[theirs[i].name + (error > 0 ? " > " : " < ") + theirs[i + 1].name];
    }
    std::vector<Interval> closed;
    for (const Interval& one : ours) {
      if (IsClosure(one.name)) closed.push_back(one);
    }
    closures.Add(theirs, closed);
  }
};

void Print(const char* who, const std::string& voice, Figures& figures) {
  std::sort(figures.errors.begin(), figures.errors.end());
  const auto n = static_cast<double>(figures.errors.size());
  double sum = 0;
  for (const double error : figures.errors) sum += error;
  const auto within =
      std::upper_bound(figures.errors.begin(), figures.errors.end(), 50.0) - figures.errors.begin();
  std::printf("%-8s %-6s %5zu/%-5zu %6.1f %6.1f %6.1f %7.1f%% %4d/%-4d %6.1f %7.3f\n", who,
              voice.c_str(), figures.errors.size(), figures.boundaries,
              figures.errors[figures.errors.size() / 2], sum / n, figures.bias / n,
              100.0 * static_cast<double>(within) / n, figures.closures.hit, figures.closures.all,
              figures.closures.error_sum / figures.closures.all, figures.work_s / figures.sound_s);
  if (std::getenv("FAR") != nullptr) {
    for (const auto& [pair, count] : figures.far) std::printf("   %s: %d\n", pair.c_str(), count);
  }
  std::fflush(stdout);
}

/// Rhubarb's answer: "0.25<tab>B" lines, shape A is the closed mouth. Empty: it is not there.
bool Rhubarb(const std::string& wav, const std::string& text, std::vector<Interval>& closed,
             double& work_s) {
  std::ofstream(wav + ".txt") << text;
  const std::string command = "rhubarb -q -f tsv -r pocketSphinx -d '" + wav + ".txt' -o '" + wav +
                              ".tsv' '" + wav + "' >/dev/null 2>&1";
  const auto start = std::chrono::steady_clock::now();
  if (std::system(command.c_str()) != 0) return false;
  work_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::ifstream file(wav + ".tsv");
  double seconds = 0;
  std::string shape;
  while (file >> seconds >> shape) {
    if (!closed.empty() && closed.back().end == 0) closed.back().end = seconds * 1000;
    if (shape == "A") closed.push_back({seconds * 1000, 0, shape});
  }
  if (!closed.empty() && closed.back().end == 0) closed.back().end = 1e9;
  return true;
}

bool Measure(const std::string& voice) {
  auto flite = ssm::MakeFliteEngine();
  auto aligner = srm::PhoneAligner::Open(srm::PocketsphinxOptions().model);
  if (!aligner) {
    std::printf("%s\n", aligner.error().text.c_str());
    return false;
  }
  Figures ours;
  Closures peer;
  double peer_s = 0;
  const bool has_peer = std::system("command -v rhubarb >/dev/null 2>&1") == 0;
  const ssm::TemporaryFolder folder;
  for (const auto* list : {&speech_bench::OtherSentences(), &speech_bench::Phrases()}) {
    for (const std::string& text : *list) {
      const Speech speech = speech_bench::Say(*flite, text, voice);
      const std::vector<Interval> truth = Intervals(speech.plan.phonemes);
      const double start = speech_bench::CpuSeconds();
      const auto found = (*aligner)->Align(speech.samples, text);
      ours.work_s += speech_bench::CpuSeconds() - start;
      ours.sound_s += speech_bench::SoundSeconds(speech.samples);
      if (found) ours.Add(truth, Intervals(found->phonemes));
      if (!has_peer) continue;
      const std::string wav = folder.File("a.wav");
      std::vector<Interval> closed;
      if (ssm::WriteWav(wav, speech.samples) && Rhubarb(wav, text, closed, peer_s)) {
        peer.Add(truth, closed);
      }
    }
  }
  Print("align", voice, ours);
  if (!has_peer) return true;
  std::printf("%-8s %-6s %44s %4d/%-4d %6.1f %7.3f\n", "rhubarb", voice.c_str(), "", peer.hit,
              peer.all, peer.all > 0 ? peer.error_sum / peer.all : 0, peer_s / ours.sound_s);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-8s %-6s %11s %6s %6s %6s %8s %9s %6s %7s\n", "", "voice", "boundaries", "median",
              "mean", "bias", "<=50ms", "closures", "error", "rtf");
  const std::vector<std::string> usual = {"slt", "rms", "kal16"};
  for (const std::string& voice :
       argc > 1 ? std::vector<std::string>(argv + 1, argv + argc) : usual) {
    if (!Measure(voice)) return 1;
  }
  if (std::system("command -v rhubarb >/dev/null 2>&1") != 0) {
    std::printf("(Rhubarb Lip Sync is not on the path, its lines are left out)\n");
  }
  return 0;
}
