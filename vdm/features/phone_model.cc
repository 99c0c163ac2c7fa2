#include "vdm/features/phone_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>

namespace vdm {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr std::size_t kMostPhones = 256, kMostDensities = 4096, kMostSenones = 100'000;
constexpr float kLeastVariance = 1e-4F;
// A weight in sendump is a byte: minus the logarithm to the base 1.0001, over 1024.
const double kWeightStep = 1024 * std::log(1.0001);

/// Little-endian numbers out of a file of the model.
class ModelFile {
 public:
  static vm::Result<ModelFile> Open(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
      return vm::Fail(vm::Errc::kUnavailable,
                      "cannot read '" + path + "' (Debian: pocketsphinx-en-us)");
    }
    ModelFile out;
    out.path_ = path;
    out.bytes_.assign(std::istreambuf_iterator<char>(file), {});
    if (out.bytes_.size() > kMostBytes) return out.Wrong("longer than 64 MiB");
    return out;
  }
  std::unexpected<vm::Error> Wrong(const std::string& what) const {
    return vm::Fail(vm::Errc::kBadValue, path_ + ": " + what);
  }
  bool ok() const { return ok_; }
  std::string Text(std::size_t count) {
    if (bytes_.size() - at_ < count) ok_ = false;
    std::string text = ok_ ? bytes_.substr(at_, count) : std::string();
    if (ok_) at_ += count;
    return text;
  }
  template <typename T>
  T Value() {
    T value{};
    const std::string text = Text(sizeof value);
    if (ok_) std::memcpy(&value, text.data(), sizeof value);
    return value;
  }
  std::size_t Count() { return Value<std::uint32_t>(); }
  /// Up to a zero.
  std::string Word() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) ok_ = false;
    std::string word = ok_ ? Text(end - at_) : std::string();
    Text(1);
    return word;
  }
  bool Skip(std::string_view end) {
    const std::size_t found = bytes_.find(end, at_);
    ok_ = ok_ && found != std::string::npos;
    if (ok_) at_ = found + end.size();
    return ok_;
  }

 private:
  std::string path_, bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

struct Definition {
  std::vector<std::string> phones{};
  std::size_t senones = 0;
};

vm::Result<Definition> ReadDefinition(const std::string& folder) {
  auto file = ModelFile::Open(folder + "/mdef");
  if (!file) return std::unexpected(file.error());
  if (file->Text(4) != "BMDF" || file->Count() != 1) {
    return file->Wrong("no binary model definition of version 1 found");
  }
  file->Text(file->Count());  // a description of the format
  const std::size_t phones = file->Count();
  file->Count();  // phones in context
  const std::size_t states = file->Count(), plain = file->Count();
  Definition out{.senones = file->Count()};
  for (int skipped = 0; skipped < 5; ++skipped) file->Count();
  if (!file->ok() || phones == 0 || phones > kMostPhones || states != PhoneModel::kStates ||
      plain != phones * PhoneModel::kStates || out.senones < plain || out.senones > kMostSenones) {
    return file->Wrong("a model with three states for each phone expected");
  }
  for (std::size_t i = 0; i < phones; ++i) out.phones.push_back(file->Word());
  if (!file->ok()) return file->Wrong("ends within the names of the phones");
  return out;
}

struct Gaussians {
  std::size_t densities = 0;
  std::vector<float> values{};  // phone, stream, density, number
};

vm::Result<Gaussians> ReadGaussians(const std::string& path, std::size_t phones) {
  auto file = ModelFile::Open(path);
  if (!file) return std::unexpected(file.error());
  if (file->Text(3) != "s3\n" || !file->Skip("endhdr\n") || file->Count() != 0x11223344) {
    return file->Wrong("no file of Gaussians of the third kind (s3) found");
  }
  const std::size_t codebooks = file->Count(), streams = file->Count();
  Gaussians out{.densities = file->Count()};
  bool fits = codebooks == phones && streams == PhoneModel::kStreams && out.densities > 0 &&
              out.densities <= kMostDensities && out.densities % 32 == 0;
  for (std::size_t i = 0; fits && i < streams; ++i) fits = file->Count() == PhoneModel::kStream;
  const std::size_t count = codebooks * streams * out.densities * PhoneModel::kStream;
  if (!file->ok() || !fits || file->Count() != count) {
    return file->Wrong(
        "a codebook for each phone (ptm) of three streams of 13 numbers expected, its size a "
        "multiple of 32");
  }
  const std::string bytes = file->Text(count * sizeof(float));
  if (!file->ok()) return file->Wrong("ends within its numbers");
  out.values.resize(count);
  std::memcpy(out.values.data(), bytes.data(), bytes.size());
  if (!std::ranges::all_of(out.values, [](float x) { return std::isfinite(x); })) {
    return file->Wrong("a value that is no number found");
  }
  return out;
}

/// Stream by stream, density by density: a byte for each senone.
vm::Result<std::string> ReadWeights(const std::string& folder, std::size_t densities,
                                    std::size_t senones) {
  auto file = ModelFile::Open(folder + "/sendump");
  if (!file) return std::unexpected(file.error());
  bool plain = true;
  std::size_t size = file->Count();
  for (; file->ok() && size != 0; size = file->Count()) {
    const std::string line = file->Text(size);
    if (line.starts_with("cluster_count") && line.substr(0, 15) != "cluster_count 0") plain = false;
  }
  const std::size_t rows = file->Count(), columns = file->Count();
  if (!file->ok() || !plain || rows != densities || columns != senones) {
    return file->Wrong("weights of " + std::to_string(densities) + " densities in " +
                       std::to_string(senones) + " states expected, without clusters");
  }
  std::string weights = file->Text(PhoneModel::kStreams * rows * columns);
  if (!file->ok()) return file->Wrong("ends within its weights");
  return weights;
}

}  // namespace

vm::Result<std::shared_ptr<const PhoneModel>> PhoneModel::Read(const std::string& folder) {
  auto definition = ReadDefinition(folder);
  if (!definition) return std::unexpected(definition.error());
  auto means = ReadGaussians(folder + "/means", definition->phones.size());
  if (!means) return std::unexpected(means.error());
  auto variances = ReadGaussians(folder + "/variances", definition->phones.size());
  if (!variances) return std::unexpected(variances.error());
  const std::size_t densities = means->densities;
  if (variances->densities != densities) {
    return vm::Fail(vm::Errc::kBadValue, folder + ": other densities in variances than in means");
  }
  auto weights = ReadWeights(folder, densities, definition->senones);
  if (!weights) return std::unexpected(weights.error());

  auto model = std::make_shared<PhoneModel>();
  model->phones_ = std::move(definition->phones);
  model->blocks_a_codebook_ = densities / kBlock;
  model->blocks_.resize(model->phones_.size() * kStreams * model->blocks_a_codebook_);
  std::size_t at = 0;
  for (std::size_t n = 0; n < model->phones_.size() * kStreams * densities; ++n) {
    Block& block = model->blocks_[n / kBlock];
    const auto lane = static_cast<Eigen::Index>(n % kBlock);
    double constant = 0;
    for (std::size_t i = 0; i < kStream; ++i, ++at) {
      const double mean = static_cast<double>(means->values[at]);
      const double variance = static_cast<double>(std::max(variances->values[at], kLeastVariance));
      block.square[i][lane] = static_cast<float>(-0.5 / variance);
      block.linear[i][lane] = static_cast<float>(mean / variance);
      constant -= 0.5 * (std::log(2 * std::numbers::pi * variance) + mean * mean / variance);
    }
    block.constant[lane] = static_cast<float>(constant);
    const std::size_t density = n % densities, stream = n / densities % kStreams;
    const std::size_t phone = n / densities / kStreams;
    for (std::size_t s = 0; s < kStates; ++s) {
      const auto byte = static_cast<unsigned char>(
          (*weights)[(stream * densities + density) * definition->senones + phone * kStates + s]);
      block.weights[s][lane] = static_cast<float>(-kWeightStep * byte);
    }
  }
  return model;
}

/// Adds the likeliest part of each state's mixture in one stream of one phone. A block stays in the
/// nearest cache while all columns go through it.
void PhoneModel::ScoreCodebook(std::size_t phone, std::size_t stream,
                               const Eigen::MatrixXf& features,
                               const std::vector<Eigen::Index>& columns, Eigen::MatrixXf& states,
                               std::vector<Best>& best) const {
  const Block* block = &blocks_[(phone * kStreams + stream) * blocks_a_codebook_];
  best.resize(columns.size());
  for (std::size_t b = 0; b < blocks_a_codebook_; ++b, ++block) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const float* x = features.col(columns[c]).data() + stream * kStream;
      Lane sum = block->constant;
      for (std::size_t i = 0; i < kStream; ++i) {
        sum += (block->square[i] * x[i] + block->linear[i]) * x[i];
      }
      for (std::size_t s = 0; s < kStates; ++s) {
        const Lane part = sum + block->weights[s];
        best[c][s] = b == 0 ? part : best[c][s].max(part);
      }
    }
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (std::size_t s = 0; s < kStates; ++s) {
      states(static_cast<Eigen::Index>(phone * kStates + s), columns[c]) += best[c][s].maxCoeff();
    }
  }
}

Eigen::MatrixXf PhoneModel::Score(const Eigen::MatrixXf& features) const {
  constexpr Eigen::Index kTogether = 32;
  Eigen::MatrixXf states =
      Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(phones_.size() * kStates), features.cols());
  std::vector<Best> best;
  for (Eigen::Index from = 0; from < features.cols(); from += kTogether) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index c = from; c < std::min(from + kTogether, features.cols()); ++c) {
      columns.push_back(c);
    }
    for (std::size_t n = 0; n < phones_.size() * kStreams; ++n) {
      ScoreCodebook(n / kStreams, n % kStreams, features, columns, states, best);
    }
  }
  return states;
}

const vm::Result<std::shared_ptr<const PhoneModel>>& InstalledPhoneModel() {
  static const auto model = PhoneModel::Read(kPhoneModelFolder);
  return model;
}

}  // namespace vdm
