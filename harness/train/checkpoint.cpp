#include "harness/train/checkpoint.h"

#include <cstring>
#include <string_view>

#include "core/error.h"
#include "core/files.h"

namespace waretwin::train {
namespace {

constexpr std::string_view kMagic = "waretwin training 3\n";

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put_text(std::string& bytes, const std::string& text) {
  put(bytes, static_cast<std::uint64_t>(text.size()));
  bytes += text;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), bytes_(read_file(file)) {
    if (take(kMagic.size(), "its first line") != kMagic)
      throw Error(file_, "no checkpoint of a training by this version; expected one, or no --resume");
  }
  std::string_view take(std::uint64_t size, const char* what) {
    if (size > bytes_.size() - at_) throw Error(file_, std::string("ends within ") + what + "; expected a whole checkpoint");
    at_ += size;
    return std::string_view(bytes_).substr(at_ - size, size);
  }
  template <class T>
  void get(T& value, const char* what) {
    std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
  }
  std::string text(const char* what) {
    std::uint64_t size = 0;
    get(size, what);
    return std::string(take(size, what));
  }

 private:
  std::filesystem::path file_;
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  std::string bytes(kMagic);
  put_text(bytes, checkpoint.config);
  put_text(bytes, checkpoint.log);
  put(bytes, checkpoint.epochs_done);
  put(bytes, checkpoint.steps);
  put(bytes, checkpoint.best_epoch);
  put(bytes, checkpoint.best_is_late);
  put(bytes, checkpoint.patience_from);
  put(bytes, checkpoint.best_fitness);
  put(bytes, checkpoint.best_ap50);
  put(bytes, checkpoint.seconds);
  put(bytes, checkpoint.validation_seconds);
  put_text(bytes, checkpoint.best_weights);
  put(bytes, static_cast<std::uint64_t>(checkpoint.tensors.size()));
  for (const at::Tensor& tensor : checkpoint.tensors) {
    const at::Tensor plain = tensor.detach().contiguous(at::MemoryFormat::Contiguous);
    put_text(bytes, std::string(reinterpret_cast<const char*>(plain.data_ptr<float>()), plain.numel() * sizeof(float)));
  }
  write_file(file, bytes);
}

void read_checkpoint(const std::filesystem::path& file, Checkpoint& checkpoint) {
  Reader in(file);
  checkpoint.config = in.text("its settings");
  checkpoint.log = in.text("its log");
  in.get(checkpoint.epochs_done, "its counters");
  in.get(checkpoint.steps, "its counters");
  in.get(checkpoint.best_epoch, "its counters");
  in.get(checkpoint.best_is_late, "its counters");
  in.get(checkpoint.patience_from, "its counters");
  in.get(checkpoint.best_fitness, "its counters");
  in.get(checkpoint.best_ap50, "its counters");
  in.get(checkpoint.seconds, "its counters");
  in.get(checkpoint.validation_seconds, "its counters");
  checkpoint.best_weights = in.text("its best weights");
  std::uint64_t count = 0;
  in.get(count, "its tensors");
  if (count != checkpoint.tensors.size()) throw Error(file, "belongs to another network");
  const at::NoGradGuard no_gradients;
  for (at::Tensor& tensor : checkpoint.tensors) {
    const std::string values = in.text("its tensors");
    if (values.size() != tensor.numel() * sizeof(float)) throw Error(file, "belongs to another network");
    at::Tensor plain = at::empty(tensor.sizes());
    std::memcpy(plain.data_ptr<float>(), values.data(), values.size());
    tensor.copy_(plain);
  }
}

std::string checkpoint_config(const std::filesystem::path& file) { return Reader(file).text("its settings"); }

}  // namespace waretwin::train
