// What the voice module can be told and asked: every slot of the original, then ours. The order of
// declaration is the order of `inq Slots` and of the table in docs/reference/slots.md.

#include "ssm/voice/voice_module.h"

namespace ssm {
namespace {

vm::Result<std::string> YesOrNo(const vm::SetValue& value) { return value.word(0); }

}  // namespace

void VoiceModule::DeclareTextSlots() {
  slots_.Declare({.name = "Text",
                  .grammar = "<markup>",
                  .access = vm::Access::kWriteOnly,
                  .help =
                      "Prepares a text, at most 8192 bytes, for speaking: Text.pho is reported "
                      "before there is sound, then Speak.stat = READY. Tags of JEIDA-62-2000 are "
                      "obeyed, and so is SSML, if the text is a <speak> element. An empty text is "
                      "a pause of 10 ms. While another is spoken it is Text.next.",
                  .on_set_later = [this](const vm::SetValue& value,
                                         vm::Reply reply) { SetText(value.text, reply); },
                  .saved = false});
  slots_.Declare({.name = "Text.next",
                  .grammar = "<markup>",
                  .access = vm::Access::kWriteOnly,
                  .help =
                      "A Text made ready while another is spoken; it becomes the present one, "
                      "with the usual reports, right after IDLE; `Speak = NOW` meanwhile speaks "
                      "it then, and a Text that is the same costs nothing more. Without speech it "
                      "is Text.",
                  .on_set_later = [this](const vm::SetValue& value,
                                         vm::Reply reply) { SetNext(value.text, reply); },
                  .saved = false});
  slots_.Declare({.name = "Text.lead",
                  .grammar = "NATURAL | <int 0..2000>",
                  .initial = "NATURAL",
                  .help = "How many ms the silence before the first sound of a Text lasts at most; "
                          "NATURAL: as the voice has it, some 200. A text that follows another "
                          "(Text.next) and pauses that were asked for keep theirs."});
  const auto told = [this](std::string name, std::string help, std::string initial = "") {
    slots_.Declare({.name = std::move(name),
                    .grammar = "<text>",
                    .access = vm::Access::kReadOnly,
                    .initial = std::move(initial),
                    .auto_output = true,
                    .help = std::move(help)});
  };
  told("Text.text", "The text as given, with its tags.");
  told("Text.pho", "Its phonemes, NAME[MS] with blanks between.");
  told("Text.dur", "Its duration in ms.", "0");
}

void VoiceModule::DeclareSpeakSlots() {
  slots_.Declare(
      {.name = "Speak",
       .grammar = "STOP | PAUSE | RESUME | <time>",
       .access = vm::Access::kWriteOnly,
       .help = "NOW, +MS, +HH:MM:SS.mmm, HH:MM:SS.mmm (local time) or @MS (this process's "
               "clock): speaks the text prepared, then or when it is ready. May be "
               "repeated after the end. PAUSE and STOP: silence within 50 ms; RESUME goes on "
               "where PAUSE came. The end, like STOP, "
               "is reported by Speak.len, Speak.utt and Speak.stat = IDLE.",
       .on_set_later =
           [this](const vm::SetValue& value, vm::Reply reply) {
             if (value.size() == 1 && value.word(0) == "STOP") {
               Stop();
               reply.Ok("STOP");
             } else if (value.size() == 1 && value.word(0) == "PAUSE") {
               Pause(reply);
             } else if (value.size() == 1 && value.word(0) == "RESUME") {
               Resume(reply);
             } else {
               SetSpeak(value.text, reply);
             }
           },
       .saved = false});
  const auto told = [this](std::string name, std::string help, std::string initial = "",
                           std::function<std::string()> on_inq = {}, bool auto_output = true) {
    slots_.Declare({.name = std::move(name),
                    .grammar = "<text>",
                    .access = vm::Access::kReadOnly,
                    .initial = std::move(initial),
                    .auto_output = auto_output,
                    .help = std::move(help),
                    .on_inq = std::move(on_inq)});
  };
  told("Speak.text", "The text really spoken: without tags.");
  told("Speak.pho", "The same as Text.pho.");
  told("Speak.dur", "The same as Text.dur.", "0");
  told("Speak.utt", "The phonemes spoken so far; after STOP only the part that was heard.", "",
       [this] {
         return spoken_ ? vm::FormatPhonemesVoice(vm::SpokenPart(spoken_->plan.phonemes, Spoken()))
                        : "";
       });
  told("Speak.len", "How many ms have been spoken so far.", "0",
       [this] { return std::to_string(Spoken().count()); });
  told("Speak.stat",
       "IDLE, PROCESSING (a text is being prepared), READY, SPEAKING, PAUSED or ERROR.", "IDLE");
  slots_.Declare({.name = "Speak.syncinterval",
                  .grammar = "<ms>",
                  .initial = "1000",
                  .auto_output = true,
                  .help = "Every so many ms of sound really heard, `tell Speak.sync = MS` says the "
                          "position; 0 = never.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    const auto interval = Millis(static_cast<long>(value.number(0)));
                    player_.set_sync_interval(ToFrames(interval));
                    return std::to_string(interval.count());
                  }});
  told("Speak.word",
       "NUMBER MS WORD: the word whose first sound was just heard, counted from 1, and "
       "its position.",
       "", {}, false);
  told("Speak.mark", "NAME MS: the BOOKMARK just passed, and its position.", "", {}, false);
  told(
      "Speak.spoken", "The words heard so far; after STOP tells what the listener knows.", "",
      [this] { return spoken_ ? spoken_->SpokenWords(Spoken()) : ""; }, false);
}

void VoiceModule::DeclareFileSlots() {
  const auto action =
      [this](std::string name, std::string help,
             void (VoiceModule::*act)(const std::string&, SoundFormat, const vm::Reply&),
             SoundFormat format, bool auto_output = false) {
        slots_.Declare({.name = std::move(name),
                        .grammar = "<file>",
                        .access = vm::Access::kWriteOnly,
                        .auto_output = auto_output,
                        .help = std::move(help),
                        .on_set_later =
                            [this, act, format](const vm::SetValue& value, vm::Reply reply) {
                              const std::string path = value.word(0);
                              const auto carry_out = [this, act, path, format, reply] {
                                (this->*act)(path, format, reply);
                              };
                              if (!PutOff(carry_out, reply)) carry_out();
                            },
                        .saved = false});
      };
  const std::string info = " FILE.info gets the text and the phonemes.";
  action("SaveRAW", "Writes the prepared text's sound, 16 kHz 16 bit mono, big endian." + info,
         &VoiceModule::Save, SoundFormat::kRaw);
  action(
      "Save",
      "The same as SaveRAW, reported as `rep Save = FILE` when it is done; FILE.wav is a WAV file "
      "with its phonemes in FILE.wav.lab.",
      &VoiceModule::SaveAndTell, SoundFormat::kRaw, true);
  action("SaveWAV", "Writes the prepared text's sound as a WAV file." + info, &VoiceModule::Save,
         SoundFormat::kWav);
  action("LoadRAW", "Loads what SaveRAW wrote, with its FILE.info, ready to Speak.",
         &VoiceModule::Load, SoundFormat::kRaw);
  action("LoadWAV", "Loads a WAV file, 16 kHz mono, with its FILE.info, ready to Speak.",
         &VoiceModule::Load, SoundFormat::kWav);
  slots_.Declare({.name = "SpeechFile",
                  .grammar = "<file>",
                  .auto_output = true,
                  .help = "The file loaded last; to set it is the same as LoadRAW.",
                  .on_set_later =
                      [this](const vm::SetValue& value, vm::Reply reply) {
                        const std::string path = value.word(0);
                        const auto load = [this, path, reply] {
                          Load(path, SoundFormat::kRaw, reply);
                        };
                        if (!PutOff(load, reply)) load();
                      },
                  .saved = false});
  action("SavePros",
         "Writes how the prepared text is said: its phonemes with durations, and every 5 ms the "
         "pitch (logarithm of Hz) and the loudness.",
         &VoiceModule::SavePros, SoundFormat::kRaw);
  action("LoadPros",
         "Prepares the text of a file that SavePros wrote, said as the file says: durations, pitch "
         "and loudness may have been changed, the phonemes must be those of the text.",
         &VoiceModule::LoadPros, SoundFormat::kRaw);
  slots_.Declare({.name = "ProsFile",
                  .grammar = "<file>",
                  .auto_output = true,
                  .help = "The prosody file loaded last; to set it is the same as LoadPros.",
                  .on_set_later =
                      [this](const vm::SetValue& value, vm::Reply reply) {
                        const std::string path = value.word(0);
                        const auto load = [this, path, reply] {
                          LoadPros(path, SoundFormat::kRaw, reply);
                        };
                        if (!PutOff(load, reply)) load();
                      },
                  .saved = false});
  action("ParsedText",
         "Prepares an analysis made by hand: a file of <W2 orth=WORD pron=KANA/> in S and AP, with "
         "the tags of JEIDA-62-2000 between.",
         &VoiceModule::LoadParsed, SoundFormat::kRaw);
  slots_.Declare({.name = "AutoPlay",
                  .grammar = "YES | NO",
                  .initial = auto_play_ ? "YES" : "NO",
                  .help = "YES: every text is spoken as soon as it is prepared.",
                  .on_set = [this](const vm::SetValue& value) {
                    auto_play_ = value.word(0) == "YES";
                    return YesOrNo(value);
                  }});
  slots_.Declare({.name = "AutoPlayDelay",
                  .grammar = "<ms>",
                  .initial = std::to_string(options_.auto_play_delay.count()),
                  .help = "With AutoPlay, ms from the phonemes to the first sound.",
                  .on_set = [](const vm::SetValue& value) -> vm::Result<std::string> {
                    return std::to_string(static_cast<long>(value.number(0)));
                  },
                  .quoted = true});
  slots_.Declare(
      {.name = "Record",
       .grammar = "STOP | <file>",
       .initial = "STOP",
       .help = "FILE.wav: from this instant on keeps what is heard, with the silence "
               "between, until STOP; at most 24 hours. On a virtual clock exact to the sample.",
       .on_set = [this](const vm::SetValue& value) { return SetRecord(value.word(0)); },
       .saved = false});
  slots_.DeclareTold("Sink", sink_->name(),
                     "Where the sound goes: null, portaudio:DEVICE or file:PATH (--sink).");
  slots_.Declare({.name = "Sound.to",
                  .grammar = "NONE | <file>",
                  .initial = "NONE",
                  .help =
                      "unix:PATH of a socket that somebody listens at: gets a copy of what is "
                      "heard, with its times, up to 400 ms before it is (docs/speech.md). NONE: "
                      "no longer.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (!options_.send_sound) {
                      if (value.word(0) == "NONE") return "NONE";
                      return vm::Fail(vm::Errc::kUnavailable, "this voice has no sound to send");
                    }
                    if (auto sent = options_.send_sound(value.word(0)); !sent) {
                      return std::unexpected(sent.error());
                    }
                    return value.word(0);
                  },
                  .on_inq = [this]() -> std::string {
                    return options_.sound_goes_to ? options_.sound_goes_to() : "NONE";
                  },
                  .saved = false});
}

void VoiceModule::DeclareLogSlots() {
  slots_.Declare({.name = "Log",
                  .grammar = "NO | CONSOLE | <file>",
                  .initial = "NO",
                  .help = "Where the entries chosen by Log.* go: a file, CONSOLE (stderr) or NO.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (auto opened = log_.Open(value.word(0)); !opened) {
                      return std::unexpected(opened.error());
                    }
                    return value.word(0);
                  }});
  const struct {
    const char* kind;
    const char* what;
    bool known;
  } kinds[] = {{"conf", "the configuration", false},
               {"text", "the text as given", true},
               {"arrangedText", "the text without tags", true},
               {"chasen", "the morphological analyser's output", false},
               {"tag", "the tags", false},
               {"phoneme", "the phonemes", true},
               {"mora", "the morae", false},
               {"morph", "the morphemes", false},
               {"aphrase", "the accent phrases", false},
               {"breath", "the breath groups", false},
               {"sentence", "each sentence made into sound", true}};
  for (const auto& kind : kinds) {
    slots_.Declare({.name = std::string("Log.") + kind.kind,
                    .grammar = "YES | NO",
                    .initial = "NO",
                    .help = std::string("YES: the log has ") + kind.what +
                            (kind.known ? "." : "; not with this engine."),
                    .on_set = [this, kind](const vm::SetValue& value) -> vm::Result<std::string> {
                      const bool wanted = value.word(0) == "YES";
                      if (wanted && !kind.known) {
                        return vm::Fail(vm::Errc::kUnavailable,
                                        std::string("this engine cannot log ") + kind.what);
                      }
                      log_.Choose(kind.kind, wanted);
                      return YesOrNo(value);
                    }});
  }
  slots_.Declare({.name = "Err",
                  .grammar = "CONSOLE | <file>",
                  .initial = "CONSOLE",
                  .help = "Where error texts go: appended to a file, or CONSOLE (stderr).",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (!options_.redirect_errors) {
                      return vm::Fail(vm::Errc::kUnavailable,
                                      "errors cannot be sent elsewhere here");
                    }
                    if (auto moved = options_.redirect_errors(value.word(0)); !moved) {
                      return std::unexpected(moved.error());
                    }
                    return value.word(0);
                  }});
}

void VoiceModule::DeclareRefused(const std::string& name, const std::string& why, bool readable) {
  slots_.Declare({.name = name,
                  .grammar = "<text>",
                  .access = readable ? vm::Access::kReadWrite : vm::Access::kWriteOnly,
                  .help = "Of the original; refused: " + why + ".",
                  .on_set = [why](const vm::SetValue&) -> vm::Result<std::string> {
                    return vm::Fail(vm::Errc::kUnavailable, why);
                  },
                  .saved = false});
}

}  // namespace ssm
