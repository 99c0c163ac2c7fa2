#pragma once

#include <string_view>

#include "ssm/voice/text_tags.h"
#include "vm_protocol/core/result.h"

namespace ssm {

/// True for a text that is SSML: its first element is <speak ...>.
bool IsSsml(std::string_view text);

/// Reads the W3C's Speech Synthesis Markup Language 1.1 into manners of speaking:
///   mark name    reported by Speak.mark         break time, strength (none to x-strong)
///   prosody rate pitch volume: words (slow, x-high, loud...), percent, factors ("120%", "+10%",
///                "1.2"), volume also in dB ("+6dB"), pitch also in semitones ("+2st")
///   emphasis level        sub alias             p, s: pauses of 400 and 200 ms
///   say-as interpret-as: characters, spell-out, digits, telephone; others are read as they are
///   audio src    the file is played; what it holds is spoken if there is no src
///   voice name   a speaker; voice and lang xml:lang are obeyed by script only
///   phoneme ph in IPA (alphabet ipa or none), x-sampa, x-arpabet, or kana: that pronunciation
///                where the engine can (flite, espeak-ng; kana: Japanese); what cannot be read is
///                spoken as it is written
/// Unknown elements are left out, what they hold is spoken; metadata is not. Numbers beyond the
/// ranges of TaggedText are taken to their end.
/// Errors: kSyntax with line and reason for broken XML, entities declared, depth over 64.
vm::Result<TaggedText> ParseSsml(std::string_view text);

/// Either of the two markups, told apart by IsSsml.
vm::Result<TaggedText> ReadMarkup(std::string_view text);

}  // namespace ssm
