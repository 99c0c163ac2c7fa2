#include "srm/align/speech_guesser.h"

#include <algorithm>
#include <utility>

#include "srm/align/pause_edges.h"
#include "srm/align/segment_collector.h"
#include "vm_protocol/core/lower_case.h"

namespace srm {
namespace {

// Words are told better by what stands around them; a decoder's memory grows with the sound.
constexpr Millis kLongestPiece{20'000};

/// How far words are to be trusted, 0 to 1 (docs/vdm.md, Recordings). `fit`: how much worse than
/// free phonemes they fit, by frame; `likely`: how likely they are among all that the decoder took
/// into account, on the mean.
double ConfidenceOf(double fit, double likely) {
  return std::clamp((fit + 20 * likely + 17) / 5, 0.0, 1.0);
}
// The decoder tells scores out of a lattice so many times as large.
constexpr double kLatticeScale = 1024;

/// The phonemes from one instant to another.
vm::PhonemeList Cut(const vm::PhonemeList& phonemes, const SoundPiece& piece) {
  vm::PhonemeList cut;
  Millis at{0};
  for (const vm::Phoneme& phoneme : phonemes) {
    const Millis start = std::max(at, piece.start);
    at += phoneme.duration;
    if (const Millis end = std::min(at, piece.end); end > start)
      cut.push_back({phoneme.name, end - start});
  }
  return cut;
}

/// `more` begins where `all` ends.
void Append(Alignment& all, Alignment more) {
  const Millis start = vm::TotalDuration(all.phonemes);
  for (vm::Phoneme& phoneme : more.phonemes) {
    const bool goes_on =
        phoneme.name == "pau" && !all.phonemes.empty() && all.phonemes.back().name == "pau";
    if (goes_on) {
      all.phonemes.back().duration += phoneme.duration;
    } else {
      all.phonemes.push_back(std::move(phoneme));
    }
  }
  for (HeardWord& word : more.words) {
    word.start += start;
    word.end += start;
    all.words.push_back(std::move(word));
  }
}

}  // namespace

std::vector<SoundPiece> PiecesOf(const vm::PhonemeList& phonemes, Millis longest) {
  std::vector<SoundPiece> pieces;
  Millis at{0}, start{0}, pause{0};  // the middle of the last pause of this piece; start: none
  const auto cut = [&](Millis where) {
    pieces.push_back({start, where});
    start = pause = where;
  };
  for (const vm::Phoneme& phoneme : phonemes) {
    const Millis end = at + phoneme.duration;
    const Millis middle = at + phoneme.duration / 2;
    if (phoneme.name == "pau" && middle - start <= longest) pause = middle;
    while (end - start > longest) cut(pause > start ? pause : start + longest);
    if (phoneme.name == "pau" && middle > start) pause = middle;
    at = end;
  }
  if (at > start) cut(at);
  return pieces;
}

struct SpeechGuesser::Parts {
  std::unique_ptr<PhoneAligner> aligner;
  DecoderPtr phonemes, words;
  Dither dither;
  std::vector<double> free_scores;  // of the phonemes that fit best, by frame of the whole sound

  vm::PhonemeList Phonemes(const std::vector<std::int16_t>& samples) {
    HearWhole(phonemes.get(), dither.Add(samples));
    SegmentCollector collector(samples.size());
    free_scores.clear();
    for (ps_seg_t* seg = ps_seg_iter(phonemes.get()); seg != nullptr; seg = ps_seg_next(seg)) {
      const std::string name = ps_seg_word(seg);
      const Segment part = ReadSegment(seg);
      if (part.frames() > 0)
        free_scores.resize(static_cast<std::size_t>(part.last) + 1, part.score / part.frames());
      collector.Add(IsFiller(name) ? "pau" : vm::LowerCase(name), part.first);
    }
    return collector.Finish();
  }

  /// The words of a piece; none where they are not to be trusted. REQUIRES: Phonemes of the whole.
  Alignment Words(const std::vector<std::int16_t>& samples, const SoundPiece& piece) {
    HearWhole(words.get(), dither.Add(samples));
    std::string text;
    double likely = 0, fit = 0, frames = 0;
    for (ps_seg_t* seg = ps_seg_iter(words.get()); seg != nullptr; seg = ps_seg_next(seg)) {
      const Segment part = ReadSegment(seg);
      const std::string word = ps_seg_word(seg);
      if (IsFiller(word) || part.frames() <= 0) continue;
      text += word.substr(0, word.find('(')) + " ";
      likely += part.frames() * logmath_exp(ps_get_logmath(words.get()),
                                            ps_seg_prob(seg, nullptr, nullptr, nullptr));
      fit += part.score / kLatticeScale;
      const auto first = static_cast<std::size_t>(piece.start.count() / kFrameMs + part.first);
      for (std::size_t i = first; i < first + static_cast<std::size_t>(part.frames()); ++i)
        fit -= i < free_scores.size() ? free_scores[i] : 0;
      frames += part.frames();
    }
    const double confidence = frames > 0 ? ConfidenceOf(fit / frames, likely / frames) : 0;
    if (confidence <= 0) return {};
    auto aligned = aligner->Align(samples, text);
    if (!aligned) return {};
    for (HeardWord& word : aligned->words) word.confidence = confidence;
    return std::move(*aligned);
  }
};

SpeechGuesser::SpeechGuesser(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
SpeechGuesser::~SpeechGuesser() = default;

vm::Result<std::unique_ptr<SpeechGuesser>> SpeechGuesser::Open(const std::string& model) {
  auto aligner = PhoneAligner::Open(model);
  if (!aligner) return std::unexpected(aligner.error());
  auto phonemes = OpenDecoder(model, {{"-allphone", model + "/en-us-phone.lm.bin"},
                                      {"-allphone_ci", "yes"},
                                      {"-beam", "1e-20"},
                                      {"-pbeam", "1e-20"},
                                      {"-lw", "2.0"}});
  if (!phonemes) return std::unexpected(phonemes.error());
  auto words = OpenDecoder(model, {{"-dict", model + "/cmudict-en-us.dict"},
                                   {"-lm", model + "/en-us.lm.bin"},
                                   {"-fwdflat", "yes"},
                                   {"-maxhmmpf", "3000"},
                                   {"-bestpath", "yes"}});
  if (!words) return std::unexpected(words.error());
  auto parts = std::make_unique<Parts>();
  parts->aligner = std::move(*aligner);
  parts->phonemes = std::move(*phonemes);
  parts->words = std::move(*words);
  return std::unique_ptr<SpeechGuesser>(new SpeechGuesser(std::move(parts)));
}

Alignment SpeechGuesser::Guess(const std::vector<std::int16_t>& samples) {
  const vm::PhonemeList phonemes = parts_->Phonemes(samples);
  Alignment guess;
  for (const SoundPiece& piece : PiecesOf(phonemes, kLongestPiece)) {
    const auto at = [&](Millis ms) {
      const auto sample = static_cast<std::size_t>(ms.count()) * kFramesPerMs;
      return samples.begin() + static_cast<std::ptrdiff_t>(std::min(sample, samples.size()));
    };
    const std::vector<std::int16_t> sound(at(piece.start), at(piece.end));
    Alignment part = parts_->Words(sound, piece);
    if (part.words.empty()) {
      part.phonemes = Cut(phonemes, piece);
      PlacePauses(part, sound);
    }
    Append(guess, std::move(part));
  }
  return guess;
}

}  // namespace srm
