#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// A text with its tags taken out and turned into manners of speaking.
struct TaggedText {
  std::string plain;               ///< the text to be spoken
  std::vector<SpeechSpan> spans;   ///< voice "" = the current speaker; numbers are factors
  std::vector<std::string> notes;  ///< what was asked for and is not done, a sentence each
};

/// Reads the tags of JEIDA-62-2000 as the original voice module knew them. Upper case, attributes
/// in double quotes. Honoured:
///   <SILENCE MSEC="500"/>             0 to 60000; also without the slash
///   <RATE SPEED="1.2">...</RATE>      relative duration, 0.2 to 5
///   <VOLUME LEVEL="0.5">...</VOLUME>  0.01 to 4
///   <PITCH LEVEL="1.1">...</PITCH>    0.5 to 2
///   <VOICE OPTIONAL="name">...</VOICE>
///   <BOOKMARK MARK="name"/>           reported by Speak.mark
///   <EMPH>...</EMPH>                  a little slower, higher and louder
///   <SPELL>...</SPELL>                letter by letter
///   <PRON SYM="kana">...</PRON>       in that reading (kana only; the accent mark is left out)
///   <CONTEXT TYPE="DIGITS">           also PHONE: digit by digit. NUMBER, DATE and TIME are read
///   as
///                                     the voice reads them anyway
///   <RESET/>                          ends every manner that is open
/// Numbers beyond the range are taken to its end. The others (SPEECH APB LANG PARTOFSP REGWORD W1)
/// are taken out and what they enclose is spoken as it is: the engines find accent phrases and
/// languages themselves. A lone closing tag is dropped; what is no tag of the list, "1 < 2" or
/// "<b>", is text. "&lt; &gt; &amp; &quot;" stand for their signs. Pure; never fails.
TaggedText ParseTaggedText(std::string_view text);

}  // namespace ssm
