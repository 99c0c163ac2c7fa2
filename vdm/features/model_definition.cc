#include "vdm/features/model_definition.h"

#include "vdm/features/phone_model.h"

namespace vdm {
namespace {

constexpr std::size_t kMostPhones = 256, kMostSenones = 100'000, kMostTriphones = 1'000'000;

}  // namespace

vm::Result<ModelDefinition> ReadDefinition(ModelFile& mdef) {
  if (mdef.Text(4) != "BMDF" || mdef.Count() != 1) {
    return mdef.Wrong("no binary model definition of version 1 found");
  }
  mdef.Text(mdef.Count());  // a description of the format
  const std::size_t phones = mdef.Count();
  ModelDefinition out{.triphones = mdef.Count()};
  const std::size_t states = mdef.Count(), plain = mdef.Count();
  out.senones = mdef.Count();
  mdef.Count();  // transition matrices
  out.sequences = mdef.Count();
  mdef.Count();  // neighbours of a phone
  out.tree_nodes = mdef.Count();
  mdef.Count();  // which is silence
  if (!mdef.ok() || phones == 0 || phones > kMostPhones || states != PhoneModel::kStates ||
      plain != phones * PhoneModel::kStates || out.senones < plain || out.senones > kMostSenones ||
      out.triphones > kMostTriphones || out.sequences > kMostTriphones ||
      out.tree_nodes > kMostTriphones) {
    return mdef.Wrong("a model with three states for each phone expected");
  }
  std::size_t length = 0;
  for (std::size_t i = 0; i < phones; ++i) {
    out.phones.push_back(mdef.Word());
    length += out.phones.back().size() + 1;
  }
  if (!mdef.ok()) return mdef.Wrong("ends within the names of the phones");
  mdef.Text((4 - length % 4) % 4);
  return out;
}

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

}  // namespace vdm
