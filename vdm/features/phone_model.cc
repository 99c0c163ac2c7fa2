#include "vdm/features/phone_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "vdm/features/model_definition.h"
#include "vdm/features/model_file.h"

namespace vdm {
namespace {

constexpr std::size_t kMostDensities = 4096;
constexpr float kLeastVariance = 1e-4F;

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

}  // namespace

vm::Result<std::shared_ptr<const PhoneModel>> PhoneModel::Read(const std::string& folder) {
  auto file = ModelFile::Open(folder + "/mdef");
  if (!file) return std::unexpected(file.error());
  auto definition = ReadDefinition(*file);
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
      block.weights[s][lane] = WeightOf(byte);
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

void PhoneModel::Densities(std::size_t phone, const float* features,
                           std::span<float> densities) const {
  const Block* block = &blocks_[phone * kStreams * blocks_a_codebook_];
  float* out = densities.data();
  for (std::size_t stream = 0; stream < kStreams; ++stream) {
    const float* x = features + stream * kStream;
    for (std::size_t b = 0; b < blocks_a_codebook_; ++b, ++block, out += kBlock) {
      Lane sum = block->constant;
      for (std::size_t i = 0; i < kStream; ++i) {
        sum += (block->square[i] * x[i] + block->linear[i]) * x[i];
      }
      Eigen::Map<Lane>{out} = sum;
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
