#include "ssm/voice/layers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/reshape.h"
#include "ssm/voice/sentences.h"
#include "ssm/voice/word_places.h"

namespace ssm {
namespace {

constexpr std::size_t kFadeFrames = 5 * kFramesPerMs;
/// How many times as long, or as short, a duration that was asked for makes its words.
constexpr double kMostStretched = 10;

bool IsPause(const vm::Phoneme& phoneme) { return phoneme.name == "pau" || phoneme.name == "sil"; }

bool IsBlank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

/// What the engine itself can do.
struct OwnManner {
  double stretch, pitch, volume;
  explicit OwnManner(const SpeechSpan& span)
      : stretch(span.stretch), pitch(span.pitch), volume(span.volume) {}
  bool operator==(const OwnManner&) const = default;
};

/// Text without a gap that one voice speaks in one language.
class Group {
 public:
  explicit Group(Layers& layers) : layers_(layers) {}

  void Add(const SpeechSpan& span) {
    const bool goes_on =
        parts_.empty() || (GoesOn(*parts_.back().span, span) && !span.begins_sentence);
    if (!goes_on) Flush();
    begins_sentence_ = begins_sentence_ || span.begins_sentence;
    parts_.push_back({&span, text_.size()});
    text_ += span.text;
  }
  void Flush() {
    if (!IsBlank(text_)) {
      const std::size_t first = layers_.spans.size();
      std::size_t begin = 0;
      for (const std::string_view sentence : CutSentences(text_)) {
        AddSentence(begin, begin + sentence.size(), first);
        begin += sentence.size();
      }
    } else {
      layers_.text += text_;
    }
    parts_.clear();
    text_.clear();
    begins_sentence_ = false;
  }

 private:
  struct Part {
    const SpeechSpan* span;
    std::size_t begin;  ///< byte of text_
  };

  static bool GoesOn(const SpeechSpan& a, const SpeechSpan& b) {
    return a.voice == b.voice && a.language == b.language;
  }
  std::size_t EndOf(std::size_t part) const {
    return part + 1 < parts_.size() ? parts_[part + 1].begin : text_.size();
  }

  /// The manner a sentence has around those that are inside of it; of several, that of most
  /// letters.
  OwnManner OutermostOf(std::size_t begin, std::size_t end) const {
    struct Share {
      OwnManner manner;
      unsigned depth;
      std::size_t letters;
    };
    std::vector<Share> shares;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const std::size_t from = std::max(begin, parts_[i].begin), to = std::min(end, EndOf(i));
      if (from >= to || IsBlank(std::string_view(text_).substr(from, to - from))) continue;
      const SpeechSpan& span = *parts_[i].span;
      const OwnManner manner(span);
      auto share = std::ranges::find(shares, manner, &Share::manner);
      if (share == shares.end()) share = shares.insert(share, {manner, span.depth, 0});
      share->depth = std::min(share->depth, span.depth);
      share->letters += to - from;
    }
    if (shares.empty()) return OwnManner(*parts_.front().span);
    return std::ranges::min_element(shares,
                                    [](const Share& a, const Share& b) {
                                      return a.depth != b.depth ? a.depth < b.depth
                                                                : a.letters > b.letters;
                                    })
        ->manner;
  }

  void AddSentence(std::size_t begin, std::size_t end, std::size_t first) {
    const OwnManner own = OutermostOf(begin, end);
    auto& spans = layers_.spans;
    if (spans.size() == first || OwnManner(spans.back()) != own) {
      SpeechSpan span;
      span.voice = parts_.front().span->voice;
      span.language = parts_.front().span->language;
      span.feeling = parts_.front().span->feeling;
      span.begins_sentence = begins_sentence_ && spans.size() == first;
      span.stretch = own.stretch;
      span.pitch = own.pitch;
      span.volume = own.volume;
      spans.push_back(std::move(span));
    }
    spans.back().text += text_.substr(begin, end - begin);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const std::size_t from = std::max(begin, parts_[i].begin), to = std::min(end, EndOf(i));
      if (from >= to) continue;
      const SpeechSpan& span = *parts_[i].span;
      Layers::Manner manner{.begin = layers_.text.size(),
                            .stretch = span.stretch / own.stretch,
                            .pitch = span.pitch / own.pitch,
                            .volume = own.volume > 0 ? span.volume / own.volume : 1,
                            .intonation = span.intonation,
                            .lasts = span.lasts,
                            .element = span.element};
      layers_.text += AsWritten(std::string_view(text_).substr(from, to - from));
      manner.end = layers_.text.size();
      if (!manner.plain()) layers_.manners.push_back(std::move(manner));
    }
  }

  Layers& layers_;
  std::vector<Part> parts_;
  std::string text_;
  bool begins_sentence_ = false;
};

/// The engine's phonemes with what is laid over each of them.
class Overlay {
 public:
  Overlay(const Layers& layers, const SpeechPlan& plan)
      : layers_(layers),
        plan_(plan),
        places_(layers.text, plan.words),
        manner_of_(plan.phonemes.size(), nullptr),
        inserted_(plan.phonemes.size() + 1) {
    edges_.push_back(Millis{0});
    for (const vm::Phoneme& phoneme : plan.phonemes) {
      edges_.push_back(edges_.back() + phoneme.duration);
      lengths_.push_back(phoneme.duration);
    }
    for (const Layers::Manner& manner : layers.manners) Apply(manner);
    FitDurations();
    for (const Layers::Event& event : layers.events) inserted_[IndexAt(event.at)] += event.pause;
    // What an engine makes of nothing is only there because a plan is never empty.
    const bool nothing = plan.words.empty() && plan.phonemes.size() == 1 &&
                         plan.phonemes[0].name == "pau" && edges_.back() <= kEmptyPause;
    if (nothing && inserted_.back().count() > 0) lengths_[0] = Millis{0};
    Millis at{0};
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      starts_.push_back(at += inserted_[i]);
      at += lengths_[i];
    }
    starts_.push_back(at + inserted_.back());
  }

  SpeechPlan Plan() const {
    SpeechPlan plan;
    plan.unspoken = plan_.unspoken.empty() ? unkept_ : plan_.unspoken;
    plan.detail = plan_.detail;
    for (std::size_t i = 0; i <= lengths_.size(); ++i) {
      AddPause(plan.phonemes, inserted_[i]);
      if (i == lengths_.size() || lengths_[i].count() == 0) continue;
      plan.phonemes.push_back({plan_.phonemes[i].name, lengths_[i]});
    }
    for (const WordTime& word : plan_.words) {
      plan.words.push_back({word.text, Start(word.start), End(word.end)});
    }
    for (const MarkTime& mark : plan_.marks) plan.marks.push_back({mark.name, Start(mark.at)});
    AddMarks(plan.marks);
    // Of those at one instant the order stays; std::stable_sort is deprecated inside for clang.
    std::multimap<decltype(MarkTime::at), MarkTime> in_order;
    for (MarkTime& mark : plan.marks) in_order.emplace(mark.at, std::move(mark));
    plan.marks.clear();
    for (auto& [at, mark] : in_order) plan.marks.push_back(std::move(mark));
    return plan;
  }

  std::vector<SoundPart> Parts() const {
    std::vector<SoundPart> parts;
    for (std::size_t i = 0; i <= lengths_.size(); ++i) {
      if (inserted_[i].count() > 0) {
        parts.push_back({.from = edges_[i], .to = edges_[i], .length = inserted_[i]});
      }
      if (i == lengths_.size()) break;
      const Layers::Manner* manner = manner_of_[i];
      const bool goes_on = i > 0 && inserted_[i].count() == 0 && manner_of_[i - 1] == manner;
      if (!goes_on) parts.push_back(PartOf(manner, i));
      parts.back().to = edges_[i + 1];
      parts.back().length += lengths_[i];
      if (manner != nullptr) parts.back().end01 = PlaceIn(*manner, starts_[i] + lengths_[i]);
    }
    if (std::ranges::all_of(parts, &SoundPart::plain)) parts.clear();
    return parts;
  }

 private:
  static void AddPause(vm::PhonemeList& phonemes, Millis length) {
    if (length.count() == 0) return;
    if (!phonemes.empty() && IsPause(phonemes.back())) {
      phonemes.back().duration += length;
    } else {
      phonemes.push_back({"pau", length});
    }
  }

  /// The phoneme that begins nearest to an instant; the number of phonemes for the end.
  std::size_t IndexAt(Millis instant) const {
    const auto after = std::ranges::lower_bound(edges_, instant);
    if (after == edges_.end()) return edges_.size() - 1;
    if (after == edges_.begin()) return 0;
    const bool before = instant - *std::prev(after) < *after - instant;
    return static_cast<std::size_t>((before ? std::prev(after) : after) - edges_.begin());
  }
  std::size_t IndexAt(std::size_t text_byte) const {
    const auto instant = places_.Begin(text_byte);
    return instant ? IndexAt(*instant) : lengths_.size();
  }

  void Apply(const Layers::Manner& manner) {
    const auto begin = places_.Begin(manner.begin), end = places_.End(manner.end);
    if (!begin || !end || *end <= *begin) return;
    const std::size_t first = IndexAt(*begin), last = IndexAt(*end);
    for (std::size_t i = first; i < last; ++i) {
      manner_of_[i] = &manner;
      const double length = static_cast<double>(lengths_[i].count()) * manner.stretch;
      lengths_[i] = std::max(Millis{1}, Millis(std::lround(length)));
    }
  }

  /// Elements that shall last so long.
  void FitDurations() {
    std::map<unsigned, std::pair<Millis, Millis>> wanted;  // element -> its length, the wanted one
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      if (manner_of_[i] == nullptr || manner_of_[i]->lasts.count() == 0) continue;
      auto& [own, lasts] = wanted[manner_of_[i]->element];
      own += lengths_[i];
      lasts = manner_of_[i]->lasts;
    }
    std::map<unsigned, double> rest;
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      if (manner_of_[i] == nullptr || manner_of_[i]->lasts.count() == 0) continue;
      const auto& [own, lasts] = wanted[manner_of_[i]->element];
      const double asked = static_cast<double>(lasts.count()) / static_cast<double>(own.count());
      const double factor = std::clamp(asked, 1 / kMostStretched, kMostStretched);
      if (factor != asked && unkept_.empty()) {
        unkept_ = "a duration of " + std::to_string(lasts.count()) + " ms is asked of " +
                  std::to_string(own.count()) +
                  " ms of speech, which is made at most ten times as long or as short";
      }
      double& carried = rest[manner_of_[i]->element];
      const double exact = static_cast<double>(lengths_[i].count()) * factor + carried;
      lengths_[i] = std::max(Millis{1}, Millis(std::lround(exact)));
      carried = exact - static_cast<double>(lengths_[i].count());
    }
  }

  /// An instant of the engine's as the beginning, or the end, of something.
  Millis Start(Millis instant) const {
    const auto after = std::ranges::upper_bound(edges_, instant);
    if (after == edges_.end()) return starts_.back();
    return Inside(static_cast<std::size_t>(after - edges_.begin()) - 1, instant);
  }
  Millis End(Millis instant) const {
    const auto at = std::ranges::lower_bound(edges_, instant);
    if (at == edges_.end()) return starts_.back();
    if (at == edges_.begin()) return Millis{0};
    return Inside(static_cast<std::size_t>(at - edges_.begin()) - 1, instant);
  }
  Millis Inside(std::size_t i, Millis instant) const {
    const Millis own = edges_[i + 1] - edges_[i];
    return own.count() == 0
               ? starts_[i]
               : starts_[i] + (instant - edges_[i]) * lengths_[i].count() / own.count();
  }

  void AddMarks(std::vector<MarkTime>& marks) const {
    std::map<std::size_t, Millis> passed;  // pauses put in before a phoneme so far
    for (const Layers::Event& event : layers_.events) {
      const std::size_t i = IndexAt(event.at);
      Millis& here = passed[i];
      here += event.pause;
      if (event.mark.empty()) continue;
      Millis at = starts_[i] - inserted_[i] + here;
      const bool ends_in_words = layers_.spans.empty() || layers_.spans.back().audio.empty();
      if (i == lengths_.size() && here.count() == 0 && ends_in_words && !plan_.words.empty()) {
        at = End(plan_.words.back().end);
      }
      marks.push_back({event.mark, at});
    }
  }

  SoundPart PartOf(const Layers::Manner* manner, std::size_t i) const {
    SoundPart part{.from = edges_[i]};
    if (manner == nullptr) return part;
    part.pitch = manner->pitch;
    part.volume = manner->volume;
    part.intonation = manner->intonation;
    part.begin01 = PlaceIn(*manner, starts_[i]);
    return part;
  }

  /// Where an instant lies in the time of the manner's element.
  double PlaceIn(const Layers::Manner& manner, Millis instant) const {
    Millis begin = starts_.back(), end{0};
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      if (manner_of_[i] == nullptr || manner_of_[i]->element != manner.element) continue;
      begin = std::min(begin, starts_[i]);
      end = std::max(end, starts_[i] + lengths_[i]);
    }
    const auto length = static_cast<double>((end - begin).count());
    return length <= 0 ? 0 : static_cast<double>((instant - begin).count()) / length;
  }

  const Layers& layers_;
  const SpeechPlan& plan_;
  const WordPlaces places_;
  std::vector<const Layers::Manner*> manner_of_;  ///< of each phoneme
  std::vector<Millis> inserted_;                  ///< pause before each phoneme, and at the end
  std::vector<Millis> edges_;                     ///< of the engine's phonemes
  std::vector<Millis> lengths_;                   ///< the new ones
  std::vector<Millis> starts_;                    ///< of the new ones; the last is the end
  std::string unkept_;                            ///< of a duration that was not reached
};

/// What the contour makes of a pitch.
double Contoured(const std::vector<Intonation::Target>& contour, double at01, double hz) {
  const auto apply = [hz](const Intonation::Target& target) {
    return target.hz > 0 ? target.hz : std::max(1.0, hz * target.factor + target.shift_hz);
  };
  if (contour.empty()) return hz;
  const auto next = std::ranges::lower_bound(contour, at01, {}, &Intonation::Target::at01);
  if (next == contour.begin()) return apply(contour.front());
  if (next == contour.end()) return apply(contour.back());
  const auto& before = *std::prev(next);
  const double share = (at01 - before.at01) / (next->at01 - before.at01);
  return apply(before) * (1 - share) + apply(*next) * share;
}

/// A part and the fade behind it. The track is there if the part is neither plain nor silent.
std::vector<double> Rendered(const SoundPart& part, std::span<const std::int16_t> whole_sound,
                             const SoundTrack* track_of_it) {
  const std::size_t frames = ToFrames(part.length);
  std::vector<double> made(frames + kFadeFrames);
  if (part.from == part.to) return made;
  const auto from = static_cast<double>(ToFrames(part.from));
  const auto to = static_cast<double>(ToFrames(part.to));
  if (part.plain()) {
    for (std::size_t i = 0; i < made.size(); ++i) {
      const std::size_t at = ToFrames(part.from) + i;
      if (at < whole_sound.size()) made[i] = whole_sound[at];
    }
    return made;
  }
  const SoundTrack& track = *track_of_it;
  const double mean = track.MeanHz(from, to);
  const Intonation& tone = part.intonation;
  const double mean_wanted = tone.hz > 0 ? tone.hz : mean * part.pitch + tone.shift_hz;
  const auto whole = static_cast<double>(frames);
  const auto sound = Reshaped(track, made.size(), [&](double at) {
    const double share = whole > 0 ? std::min(1.0, at / whole) : 0;
    SoundWish wish{.from = at < whole ? from + (to - from) * share : to + at - whole};
    const double own = track.Hz(wish.from);
    if (own == 0 || mean == 0) return wish;
    const double hz = std::max(1.0, mean_wanted) * std::pow(own / mean, tone.range);
    const double place = part.begin01 + (part.end01 - part.begin01) * share;
    wish.hz = Contoured(tone.contour, place, hz);
    return wish;
  });
  for (std::size_t i = 0; i < made.size(); ++i) {
    made[i] = part.volume > 1 ? Limited(sound[i] * part.volume) : sound[i] * part.volume;
  }
  return made;
}

}  // namespace

bool Layers::Manner::plain() const {
  return stretch == 1 && pitch == 1 && volume == 1 && lasts.count() == 0 &&
         intonation == Intonation{};
}

bool SoundPart::plain() const {
  return from < to && length == to - from && pitch == 1 && volume == 1 &&
         intonation == Intonation{};
}

Layers PartLayers(const std::vector<SpeechSpan>& spans) {
  Layers layers;
  Group group(layers);
  std::size_t written = 0;  // bytes of text in the spans so far
  for (const SpeechSpan& span : spans) {
    if (!span.audio.empty()) {
      group.Flush();
      layers.spans.push_back(span);
      continue;
    }
    if (span.pause_before.count() > 0) layers.events.push_back({written, "", span.pause_before});
    if (!span.mark.empty()) layers.events.push_back({written, span.mark, Millis{0}});
    if (span.text.empty()) continue;
    group.Add(span);
    written += AsWritten(span.text).size();
  }
  group.Flush();
  return layers;
}

SpeechPlan LayOver(const Layers& layers, const SpeechPlan& plan, std::vector<SoundPart>& parts) {
  parts.clear();
  if (layers.events.empty() && layers.manners.empty()) return plan;
  const Overlay overlay(layers, plan);
  parts = overlay.Parts();
  return overlay.Plan();
}

std::vector<std::int16_t> MakeSound(std::span<const std::int16_t> sound,
                                    const std::vector<SoundPart>& parts) {
  std::optional<SoundTrack> track;  // it takes time: only where something is made of it
  if (std::ranges::any_of(parts, [](const auto& it) { return it.from < it.to && !it.plain(); })) {
    track.emplace(sound);
  }
  std::vector<std::int16_t> out;
  std::vector<double> tail;  // of the part before
  for (const SoundPart& part : parts) {
    std::vector<double> made = Rendered(part, sound, track ? &*track : nullptr);
    for (std::size_t i = 0; i < tail.size() && i < made.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(kFadeFrames);
      made[i] = made[i] * share + tail[i] * (1 - share);
    }
    const std::size_t frames = ToFrames(part.length);
    for (std::size_t i = 0; i < frames; ++i) {
      out.push_back(static_cast<std::int16_t>(std::lround(std::clamp(made[i], -32768.0, 32767.0))));
    }
    tail.assign(made.begin() + static_cast<std::ptrdiff_t>(frames), made.end());
  }
  return out;
}

}  // namespace ssm
