#include "mapper/output/map_archive.h"

#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "core/digest.h"
#include "core/error.h"
#include "core/files.h"

namespace waretwin {

namespace {

static_assert(std::endian::native == std::endian::little, "maps are written as the memory holds them");

constexpr char kMagic[] = {'W', 'A', 'R', 'E', 'T', 'W', 'I', 'N'};
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kHeader = sizeof kMagic + sizeof(std::uint32_t) + sizeof(std::uint64_t);
constexpr std::uint32_t kMostText = 1 << 16;

std::uint64_t fingerprint(const char* data, std::size_t size) {
  Digest digest;
  digest.add_bytes(data, size);
  return digest.value();
}

class Writer {
 public:
  Writer() {
    // Level 1: maps are large, and half the size at ten times the time is no bargain.
    if (deflateInit(&stream_, 1) != Z_OK) throw InternalError("zlib does not start");
  }
  ~Writer() { deflateEnd(&stream_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void bytes(const void* data, std::size_t size) {
    pending_.append(static_cast<const char*>(data), size);
    if (pending_.size() > 1 << 20) flush(Z_NO_FLUSH);
  }
  template <class T>
  void value(T v) {
    static_assert(std::is_arithmetic_v<T>);
    bytes(&v, sizeof v);
  }
  void text(const std::string& t) {
    const std::size_t size = std::min<std::size_t>(t.size(), kMostText);
    value(static_cast<std::uint32_t>(size));
    bytes(t.data(), size);
  }
  std::string finish() {
    flush(Z_FINISH);
    return std::move(out_);
  }

 private:
  void flush(int mode) {
    stream_.next_in = reinterpret_cast<Bytef*>(pending_.data());
    stream_.avail_in = static_cast<uInt>(pending_.size());
    char chunk[1 << 16];
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(chunk);
      stream_.avail_out = sizeof chunk;
      const int result = deflate(&stream_, mode);
      WARETWIN_CHECK(result != Z_STREAM_ERROR, "zlib lost its state");
      out_.append(chunk, sizeof chunk - stream_.avail_out);
    } while (stream_.avail_out == 0);
    pending_.clear();
  }

  z_stream stream_{};
  std::string pending_, out_;
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const char* data, std::size_t size) : file_(file), data_(data), left_(size) {
    if (inflateInit(&stream_) != Z_OK) throw InternalError("zlib does not start");
  }
  ~Reader() { inflateEnd(&stream_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  void bytes(void* to, std::size_t size) {
    auto* out = static_cast<Bytef*>(to);
    while (size > 0) {
      const auto piece = static_cast<uInt>(std::min<std::size_t>(size, 1 << 30));
      stream_.next_out = out;
      stream_.avail_out = piece;
      while (stream_.avail_out > 0) {
        feed();
        const int result = inflate(&stream_, Z_NO_FLUSH);
        if (result == Z_STREAM_END && stream_.avail_out > 0) fail("the map ends too early");
        if (result != Z_OK && result != Z_STREAM_END) fail("the compressed data is damaged");
      }
      out += piece;
      size -= piece;
    }
  }
  template <class T>
  T value() {
    static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
    T v;
    bytes(&v, sizeof v);
    return v;
  }
  bool flag() {
    const auto v = value<std::uint8_t>();
    if (v > 1) fail("flag " + std::to_string(v) + "; expected 0 or 1");
    return v == 1;
  }
  double number(const char* what, double low, double high) {
    const auto v = value<double>();
    if (!(v >= low && v <= high))
      fail(std::string(what) + " " + std::to_string(v) + "; expected " + std::to_string(low) + " to " + std::to_string(high));
    return v;
  }
  double finite(const char* what) { return number(what, -1e12, 1e12); }
  float finite_float(const char* what) {
    const auto v = value<float>();
    if (!std::isfinite(v)) fail(std::string(what) + " is not a finite number");
    return v;
  }
  std::int32_t integer(const char* what, std::int32_t low, std::int32_t high) {
    const auto v = value<std::int32_t>();
    if (v < low || v > high)
      fail(std::string(what) + " " + std::to_string(v) + "; expected " + std::to_string(low) + " to " + std::to_string(high));
    return v;
  }
  std::string text() {
    const auto size = value<std::uint32_t>();
    if (size > kMostText) fail("text of " + std::to_string(size) + " bytes; expected at most " + std::to_string(kMostText));
    std::string t(size, '\0');
    bytes(t.data(), size);
    return t;
  }
  void expect_end() {
    feed();
    Bytef extra;
    stream_.next_out = &extra;
    stream_.avail_out = 1;
    if (inflate(&stream_, Z_NO_FLUSH) != Z_STREAM_END || stream_.avail_out != 1 || stream_.avail_in > 0 || left_ > 0) {
      fail("more data than a map has");
    }
  }
  [[noreturn]] void fail(const std::string& problem) const { throw Error(file_, "damaged map: " + problem); }

 private:
  void feed() {
    if (stream_.avail_in > 0 || left_ == 0) return;
    const std::size_t piece = std::min<std::size_t>(left_, 1 << 30);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data_));  // zlib reads only
    stream_.avail_in = static_cast<uInt>(piece);
    data_ += piece;
    left_ -= piece;
  }

  std::filesystem::path file_;
  const char* data_;
  std::size_t left_;
  z_stream stream_{};
};

void write_config(Writer& w, const TsdfConfig& c) {
  for (const double v : {c.voxel_m, c.truncation_voxels, c.label_band_voxels, c.max_weight, c.max_depth_m, c.mesh_min_weight}) w.value(v);
  w.value(static_cast<std::int32_t>(c.clear_frames));
  w.value(static_cast<std::uint8_t>(c.inverse_square_weight));
  w.value(static_cast<std::uint8_t>(c.carve));
  w.value(static_cast<std::uint8_t>(c.method == "projection"));
  w.value(static_cast<std::uint8_t>(c.projection.forget));
}

TsdfConfig read_config(Reader& r) {
  TsdfConfig c;
  c.voxel_m = r.number("voxel_m", 0.002, 1.0);
  c.truncation_voxels = r.number("truncation_voxels", 1.0, 32.0);
  c.label_band_voxels = r.number("label_band_voxels", 0.5, 32.0);
  c.max_weight = r.number("max_weight", 1.0, 1e9);
  c.max_depth_m = r.number("max_depth_m", 0.1, 100.0);
  c.mesh_min_weight = r.number("mesh_min_weight", 0.0, 1e9);
  c.clear_frames = r.integer("clear_frames", 0, 100);
  c.inverse_square_weight = r.flag();
  c.carve = r.flag();
  c.method = r.flag() ? "projection" : "rays";
  c.projection.forget = r.flag();
  return c;
}

void write_object(Writer& w, const MappedObject& o) {
  w.value(static_cast<std::int32_t>(o.id));
  w.text(o.class_name);
  w.text(o.cuboid.frame);
  for (const double v : {o.cuboid.centre.x(), o.cuboid.centre.y(), o.cuboid.centre.z(), o.cuboid.yaw, o.cuboid.size.x(), o.cuboid.size.y(),
                         o.cuboid.size.z()}) {
    w.value(v);
  }
  w.value(o.score);
  for (const int v : {o.first_frame, o.last_frame, o.observations}) w.value(static_cast<std::int32_t>(v));
  for (const float v : {o.box.x, o.box.y, o.box.width, o.box.height}) w.value(v);
  w.value(static_cast<std::uint64_t>(o.hsv.size()));
  for (const float v : o.hsv) w.value(v);
  w.value(static_cast<std::uint64_t>(o.points_W.size()));
  for (const Eigen::Vector3f& p : o.points_W) w.bytes(p.data(), 3 * sizeof(float));
}

MappedObject read_object(Reader& r) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  MappedObject o;
  o.id = r.integer("object id", 1, kMost);
  o.class_name = r.text();
  o.cuboid.frame = r.text();
  for (int k = 0; k < 3; ++k) o.cuboid.centre[k] = r.finite("cuboid centre");
  o.cuboid.yaw = r.finite("cuboid yaw");
  for (int k = 0; k < 3; ++k) o.cuboid.size[k] = r.number("cuboid size", 0.0, 1e12);
  o.score = r.finite_float("score");
  o.first_frame = r.integer("first frame", 0, kMost);
  o.last_frame = r.integer("last frame", 0, kMost);
  o.observations = r.integer("observations", 0, kMost);
  for (float* v : {&o.box.x, &o.box.y, &o.box.width, &o.box.height}) *v = r.finite_float("box");
  // Grown as the data comes: a false count ends at the end of the data, not in a huge allocation.
  const auto bins = r.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < bins; ++i) o.hsv.push_back(r.finite_float("histogram"));
  const auto points = r.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < points; ++i) {
    Eigen::Vector3f p;
    for (int k = 0; k < 3; ++k) p[k] = r.finite_float("point");
    o.points_W.push_back(p);
  }
  return o;
}

void write_block(Writer& w, const TsdfBlock& block) {
  for (int k = 0; k < 3; ++k) w.value(static_cast<std::int32_t>(block.index[k]));
  w.bytes(block.free_frames.data(), block.free_frames.size());
  w.value(static_cast<std::uint8_t>(block.surface != nullptr));
  if (!block.surface) return;
  // One quantity after the other compresses better than voxel after voxel.
  for (const TsdfVoxel& v : block.surface->voxels) w.value(v.distance);
  for (const TsdfVoxel& v : block.surface->voxels) w.value(v.weight);
  for (const TsdfVoxel& v : block.surface->voxels) w.bytes(v.colour.data(), v.colour.size());
  for (const TsdfVoxel& v : block.surface->voxels) w.value(v.surface_frames);
  for (int v = 0; v < TsdfVolume::kVoxels; ++v) {
    const auto counts = block.surface->labels.all(v);
    w.value(static_cast<std::uint32_t>(counts.size()));
    for (const auto& [label, count] : counts) {
      w.value(label);
      w.value(count);
    }
  }
}

void read_block(Reader& r, TsdfVolume& volume) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  Eigen::Vector3i index;
  for (int k = 0; k < 3; ++k) index[k] = r.integer("block", -TsdfVolume::kMaxBlockIndex, TsdfVolume::kMaxBlockIndex);
  if (volume.find_block(index)) r.fail("a block occurs twice");
  const std::size_t position = volume.ensure_block(index);
  r.bytes(volume.block(position).free_frames.data(), TsdfVolume::kVoxels);
  if (!r.flag()) return;
  SurfaceVoxels& surface = volume.ensure_surface(position);
  for (TsdfVoxel& v : surface.voxels) v.distance = r.finite_float("distance");
  for (TsdfVoxel& v : surface.voxels) {
    v.weight = r.finite_float("weight");
    if (v.weight < 0.0f) r.fail("weight below 0");
  }
  for (TsdfVoxel& v : surface.voxels) r.bytes(v.colour.data(), v.colour.size());
  for (TsdfVoxel& v : surface.voxels) v.surface_frames = r.value<std::uint8_t>();
  for (int v = 0; v < TsdfVolume::kVoxels; ++v) {
    const auto labels = r.value<std::uint32_t>();
    std::int32_t last = -1;
    for (std::uint32_t i = 0; i < labels; ++i) {
      const std::int32_t label = r.integer("label", last < kMost ? last + 1 : kMost, kMost);
      const auto count = r.value<std::uint32_t>();
      if (count == 0) r.fail("a label that was counted 0 times");
      surface.labels.add(v, label, count);
      last = label;
    }
  }
}

}  // namespace

void save_map(const std::filesystem::path& file, const ObjectList& objects, const TsdfVolume& volume, int frames) {
  Writer w;
  w.value(static_cast<std::int32_t>(frames));
  write_config(w, volume.config());
  w.value(static_cast<std::uint64_t>(objects.size()));
  for (const MappedObject& object : objects) write_object(w, object);
  w.value(static_cast<std::uint64_t>(volume.size()));
  for (const std::size_t b : volume.sorted_positions()) write_block(w, volume.block(b));
  const std::string body = w.finish();
  const std::uint64_t print = fingerprint(body.data(), body.size());
  std::string bytes(kMagic, sizeof kMagic);
  bytes.append(reinterpret_cast<const char*>(&kVersion), sizeof kVersion);
  bytes.append(reinterpret_cast<const char*>(&print), sizeof print);
  bytes += body;
  write_file(file, bytes);
}

LoadedMap load_map(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  if (bytes.size() < kHeader || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    throw Error(file, "not a map; expected a map.waretwin as `waretwin run` or `waretwin map` writes it");
  }
  std::uint32_t version;
  std::uint64_t print;
  std::memcpy(&version, bytes.data() + sizeof kMagic, sizeof version);
  std::memcpy(&print, bytes.data() + sizeof kMagic + sizeof version, sizeof print);
  if (version != kVersion)
    throw Error(file, "map of version " + std::to_string(version) + "; expected version " + std::to_string(kVersion));
  if (fingerprint(bytes.data() + kHeader, bytes.size() - kHeader) != print)
    throw Error(file, "damaged map: cut short or changed since it was written");

  Reader r(file, bytes.data() + kHeader, bytes.size() - kHeader);
  LoadedMap map;
  map.frames = r.integer("frames", 0, std::numeric_limits<std::int32_t>::max());
  map.volume = std::make_unique<TsdfVolume>(read_config(r));
  const auto objects = r.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < objects; ++i) map.objects.push_back(read_object(r));
  const auto blocks = r.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < blocks; ++i) read_block(r, *map.volume);
  r.expect_end();
  return map;
}

}  // namespace waretwin
