#include "ssm/engines/hts_voices.h"

#include <HTS_engine.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "ssm/engines/voice_file.h"
#include "ssm/voice/resample.h"

namespace ssm {

struct HtsVoices::Library {
  Library() { HTS_Engine_initialize(&engine); }
  ~Library() { HTS_Engine_clear(&engine); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  double Rate() { return static_cast<double>(HTS_Engine_get_sampling_frequency(&engine)); }
  void Choose(const How& how);

  HTS_Engine engine{};
};

namespace {

/// The library takes texts it may write to.
std::vector<char*> Lines(std::vector<std::string>& texts) {
  std::vector<char*> lines;
  for (std::string& text : texts) lines.push_back(text.data());
  return lines;
}

bool LoadInto(HTS_Engine& engine, std::vector<std::string> files) {
  return HTS_Engine_load(&engine, Lines(files).data(), files.size()) != 0;
}

/// The library does not look at what it reads: damaged data end the process, or never come to an
/// end. So a child loads the files first and says a little with them.
bool CanBeSpoken(const std::vector<std::string>& files) {
  constexpr unsigned kWorkLimitS = 10, kLimitS = 60;
  const pid_t child = fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const rlimit little_work{kWorkLimitS, kWorkLimitS};
    setrlimit(RLIMIT_CPU, &little_work);
    alarm(kLimitS);
    if (const int null = open("/dev/null", O_WRONLY); null >= 0) dup2(null, STDERR_FILENO);
    HTS_Engine engine{};
    HTS_Engine_initialize(&engine);
    bool good = LoadInto(engine, files);
    std::vector<std::string> labels = {"xx^xx-sil+a=N/A:xx+xx+xx", "xx^sil-a+N=sil/A:0+1+1",
                                       "sil^a-N+sil=xx/A:1+2+1", "a^N-sil+xx=xx/A:xx+xx+xx"};
    good = good && HTS_Engine_synthesize_from_strings(&engine, Lines(labels).data(), labels.size());
    _exit(good ? 0 : 1);
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

}  // namespace

void HtsVoices::Library::Choose(const How& how) {
  assert(how.weights.size() == HTS_Engine_get_nvoices(&engine));
  for (std::size_t voice = 0; voice < how.weights.size(); ++voice) {
    const double weight = how.weights[voice];
    HTS_Engine_set_duration_interpolation_weight(&engine, voice, weight);
    for (std::size_t stream = 0; stream < HTS_Engine_get_nstream(&engine); ++stream) {
      HTS_Engine_set_parameter_interpolation_weight(&engine, voice, stream, weight);
      HTS_Engine_set_gv_interpolation_weight(&engine, voice, stream, weight);
    }
  }
  HTS_Engine_set_speed(&engine, how.speed);
  HTS_Engine_add_half_tone(&engine, how.half_tones);
}

HtsVoices::HtsVoices(std::unique_ptr<Library> library) : library_(std::move(library)) {}
HtsVoices::~HtsVoices() = default;

vm::Result<std::unique_ptr<HtsVoices>> HtsVoices::Load(const std::vector<std::string>& files) {
  assert(!files.empty());
  auto first = ReadVoiceFileHead(files.front());
  if (!first) return std::unexpected(first.error());
  for (const std::string& file : files) {
    auto head = ReadVoiceFileHead(file);
    if (!head) return std::unexpected(head.error());
    if (auto fit = CheckVoicesFit(*first, *head, file); !fit) return std::unexpected(fit.error());
  }
  auto library = std::make_unique<Library>();
  if (!CanBeSpoken(files) || !LoadInto(library->engine, files)) {
    std::string names;
    for (const std::string& file : files) names += (names.empty() ? "'" : ", '") + file + "'";
    return vm::Fail(vm::Errc::kBadValue, "voice file " + names + ": hts_engine cannot speak with " +
                                             (files.size() == 1 ? "it" : "them"));
  }
  if (library->Rate() < 1000 || library->Rate() > 400'000) {
    return vm::Fail(vm::Errc::kBadValue, "voice file '" + files.front() +
                                             "': SAMPLING_FREQUENCY is out of 1000 to 400000");
  }
  return std::unique_ptr<HtsVoices>(new HtsVoices(std::move(library)));
}

vm::Result<std::vector<Millis>> HtsVoices::States(const std::vector<std::string>& labels,
                                                  const How& how) {
  HTS_Engine& engine = library_->engine;
  library_->Choose(how);
  std::vector<std::string> texts = labels;
  if (!HTS_Engine_generate_state_sequence_from_strings(&engine, Lines(texts).data(),
                                                       texts.size())) {
    return vm::Fail(vm::Errc::kUnavailable, "hts_engine cannot speak these voices so mixed");
  }
  const std::size_t states = HTS_Engine_get_nstate(&engine);
  const auto period = static_cast<double>(HTS_Engine_get_fperiod(&engine));
  std::vector<Millis> ends;
  std::size_t frames = 0;
  for (std::size_t label = 0; label < labels.size(); ++label) {
    for (std::size_t state = 0; state < states; ++state) {
      frames += HTS_Engine_get_state_duration(&engine, label * states + state);
    }
    const double seconds = static_cast<double>(frames) * period / library_->Rate();
    ends.emplace_back(std::lround(seconds * 1000));
  }
  return ends;
}

vm::Result<std::vector<Millis>> HtsVoices::Ends(const std::vector<std::string>& labels,
                                                const How& how) {
  const std::lock_guard lock(mutex_);
  auto ends = States(labels, how);
  HTS_Engine_refresh(&library_->engine);
  return ends;
}

vm::Result<std::vector<std::int16_t>> HtsVoices::Sound(const std::vector<std::string>& labels,
                                                       const How& how) {
  const std::lock_guard lock(mutex_);
  HTS_Engine& engine = library_->engine;
  auto ends = States(labels, how);
  if (ends && !(HTS_Engine_generate_parameter_sequence(&engine) &&
                HTS_Engine_generate_sample_sequence(&engine))) {
    ends = vm::Fail(vm::Errc::kUnavailable, "hts_engine made no sound");
  }
  std::vector<std::int16_t> samples;
  if (ends) {
    samples.resize(HTS_Engine_get_nsamples(&engine));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double value = HTS_Engine_get_generated_speech(&engine, i);
      samples[i] = static_cast<std::int16_t>(std::lround(std::clamp(value, -32768.0, 32767.0)));
    }
  }
  const auto rate = static_cast<std::int64_t>(HTS_Engine_get_sampling_frequency(&engine));
  HTS_Engine_refresh(&engine);
  if (!ends) return std::unexpected(ends.error());
  samples = Resample(samples, rate, kSampleRateHz);
  samples.resize(ends->empty() ? 0 : ToFrames(ends->back()));
  return samples;
}

}  // namespace ssm
