#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "ssm/voice/text_tags.h"
#include "vm_protocol/core/result.h"

namespace ssm {

/// True for a text that is SSML: its root element is <speak>, whatever its prefix, and whatever
/// comes before it (declaration, comments, instructions, a document type).
bool IsSsml(std::string_view text);

/// What a markup's reader may ask of the world.
struct MarkupOptions {
  std::string language = "en";  ///< of the speaker: how <say-as> is read where nothing else is said
  /// Whether any voice speaks a language ("en", "ja"). Empty: every language is spoken.
  std::function<bool(const std::string& language)> speaks{};
  /// Whether a file can be played; else what <audio> holds is spoken. Empty: every file can.
  std::function<bool(const std::string& path)> is_sound{};
  /// The content of a lexicon. Empty: there is none.
  std::function<vm::Result<std::string>(const std::string& path)> read_file{};
};

/// Reads the W3C's Speech Synthesis Markup Language 1.1 (and 1.0) into manners of speaking:
///   mark name    reported by Speak.mark         break time, strength (none to x-strong)
///   prosody      rate: words, "80%", "+10%", "1.2"; volume: words, "+6dB", 0 to 100, "+10";
///                pitch: words, "+10%", "+2st", "+60Hz", "250Hz"; range: words, "+20%";
///                contour "(0%,+20Hz) (50%,+10%)"; duration "2s"
///   emphasis level        sub alias             p, s: pauses of 400 and 200 ms
///   say-as       spoken_forms.h: characters, digits, telephone, cardinal, ordinal, date, time,
///                currency, in English and Japanese
///   audio src    the file is played: soundLevel, speed, clipBegin, clipEnd, repeatCount,
///   repeatDur;
///                what it holds is spoken if it cannot be; desc is silent
///   voice        name (several: the first there is), gender; xml:lang of voice, lang, p, s, token
///                and w is the language of what they hold
///   phoneme ph in IPA (alphabet ipa or none), x-sampa, x-arpabet, or kana: that pronunciation
///                where the engine can (flite, espeak-ng; kana: Japanese); what cannot be read is
///                spoken as it is written
///   xml:base                   what relative uri and src are resolved against (markup_uri.h)
///   onlangfailure              of text in a language that no voice speaks (section 3.1.13), which
///   is
///                told: ignoretext leaves it out; changevoice, ignorelang and processorchoice read
///                it as what is around it
///   lexicon uri, lookup ref   a file of the Pronunciation Lexicon Specification 1.0
/// Where words and sentences end at elements: text_flow.h.
/// Unknown elements are left out, what they hold is spoken; metadata is not. What is understood and
/// cannot be done, values that are none, and numbers beyond a limit, which are taken to it, are
/// told in TaggedText::notes. Errors: kSyntax "SSML:LINE:COLUMN: reason" for broken XML, entities
/// that grow beyond measure, depth over 64.
vm::Result<TaggedText> ParseSsml(std::string_view text, const MarkupOptions& options = {});

/// Either of the two markups, told apart by IsSsml.
vm::Result<TaggedText> ReadMarkup(std::string_view text, const MarkupOptions& options = {});

}  // namespace ssm
