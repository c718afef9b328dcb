#include "scenes/gltf_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <tuple>

#include "scenes/gltf_extras.h"

namespace waretwin {

namespace {

struct PictureSize {
  int width = 0, height = 0;  // 0 x 0: not found
};

std::uint32_t big_endian(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = (value << 8) | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

PictureSize saturated(std::uint32_t width, std::uint32_t height) {
  const auto side = [](std::uint32_t v) { return static_cast<int>(std::min<std::uint32_t>(v, 0x7fffffff)); };
  return {side(width), side(height)};
}

bool is_png(const std::string& bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); }
bool is_jpeg(const std::string& bytes) { return bytes.starts_with("\xff\xd8\xff"); }

// The IHDR chunk comes first (PNG specification, 5.6).
PictureSize png_size(const std::string& bytes) {
  if (bytes.size() < 24 || bytes.compare(12, 4, "IHDR") != 0) return {};
  return saturated(big_endian(bytes, 16, 4), big_endian(bytes, 20, 4));
}

// The first start-of-frame segment holds the size (ITU-T T.81, B.2.2).
PictureSize jpeg_size(const std::string& bytes) {
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    if (static_cast<unsigned char>(bytes[at]) != 0xff) return {};
    const unsigned marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    const bool is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame) return saturated(big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2));
    const std::size_t length = big_endian(bytes, at + 2, 2);
    if (length < 2) return {};
    at += 2 + length;
  }
  return {};
}

}  // namespace

Texture decode_picture(const GltfDocument& document, const std::string& bytes, const std::string& element, std::int64_t& pixels) {
  if (!is_png(bytes) && !is_jpeg(bytes)) document.fail(element, "is neither PNG nor JPEG");
  const PictureSize size = is_png(bytes) ? png_size(bytes) : jpeg_size(bytes);
  if (size.width <= 0 || size.height <= 0) document.fail(element, "is a damaged picture");
  const std::string dimensions = std::to_string(size.width) + " x " + std::to_string(size.height);
  if (size.width > GltfLimits::kPictureSide || size.height > GltfLimits::kPictureSide) {
    document.fail(element, "has " + dimensions + " pixels; at most " + std::to_string(GltfLimits::kPictureSide) + " a side are read");
  }
  pixels += static_cast<std::int64_t>(size.width) * size.height;
  if (pixels > GltfLimits::kPicturePixels) document.fail(element, "brings the pictures of this file beyond 256 million pixels");
  cv::Mat picture;
  try {
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    picture = cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty() || picture.cols != size.width || picture.rows != size.height) document.fail(element, "is a damaged picture");
  if (picture.depth() == CV_16U) picture.convertTo(picture, CV_8U, 1.0 / 257.0);
  if (picture.depth() != CV_8U) document.fail(element, "has neither 8 nor 16 bits a channel");
  cv::Mat rgba;
  switch (picture.channels()) {
    case 1:
      cv::cvtColor(picture, rgba, cv::COLOR_GRAY2RGBA);
      break;
    case 3:
      cv::cvtColor(picture, rgba, cv::COLOR_BGR2RGBA);
      break;
    case 4:
      cv::cvtColor(picture, rgba, cv::COLOR_BGRA2RGBA);
      break;
    default:
      document.fail(element, "has " + std::to_string(picture.channels()) + " channels; expected 1, 3 or 4");
  }
  Texture texture;
  texture.width = rgba.cols;
  texture.height = rgba.rows;
  texture.rgba.assign(rgba.datastart, rgba.dataend);
  return texture;
}

namespace {

class MaterialLoader {
 public:
  MaterialLoader(const GltfDocument& document, Scene& content, std::vector<std::string>& notes)
      : document_(document), content_(content), notes_(notes) {}

  void load() {
    const auto& materials = document_.model().materials;
    for (std::size_t i = 0; i < materials.size(); ++i) content_.materials.push_back(material(i, materials[i]));
    Material plain;
    plain.name = "default";
    content_.materials.push_back(plain);
  }

 private:
  Material material(std::size_t index, const tinygltf::Material& source) {
    const std::string element = element_name("material", index, source.name);
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Material result;
    result.name = source.name;
    for (int c = 0; c < 4; ++c)
      result.base_colour[c] = factor(pbr.baseColorFactor, static_cast<std::size_t>(c), 4, 1.0, 1.0, element, "baseColorFactor");
    result.base_colour_texture = use(pbr.baseColorTexture, element);
    result.metallic = in_range(pbr.metallicFactor, 1.0, element, "metallicFactor");
    result.roughness = in_range(pbr.roughnessFactor, 1.0, element, "roughnessFactor");
    result.metallic_roughness_texture = use(pbr.metallicRoughnessTexture, element);
    result.normal_texture = use(source.normalTexture, element);
    result.normal_scale = static_cast<float>(source.normalTexture.scale);
    if (!std::isfinite(result.normal_scale)) document_.fail(element, "normalTexture.scale is not a finite number");
    double strength = 1.0;
    const auto emission = source.extensions.find("KHR_materials_emissive_strength");
    if (emission != source.extensions.end()) {
      if (const tinygltf::Value* value = member(emission->second, "emissiveStrength")) {
        strength = number_in(document_, *value, element, "emissiveStrength", 0.0, 1e6);
      }
    }
    for (int c = 0; c < 3; ++c) {
      const float value = factor(source.emissiveFactor, static_cast<std::size_t>(c), 3, 0.0, 1e6, element, "emissiveFactor");
      result.emissive[c] = value * static_cast<float>(strength);
    }
    result.emissive_texture = use(source.emissiveTexture, element);
    set_alpha(source, element, result);
    result.double_sided = source.doubleSided;
    if (const tinygltf::Value* value = waretwin_extra(source.extras, "reflectivity_850nm")) {
      result.reflectivity_850nm = static_cast<float>(number_in(document_, *value, element, "reflectivity_850nm", 0.0, 1.0));
    }
    if (const tinygltf::Value* value = waretwin_extra(source.extras, "retroreflective")) {
      result.retroreflection = retroreflection(*value, element);
    }
    return result;
  }

  float retroreflection(const tinygltf::Value& value, const std::string& element) const {
    // ASTM D4956, type I (engineer grade), white, straight ahead: 70 cd / (lx m2), where a white diffuse surface has 1 / pi.
    constexpr float kSheet = 220.0f;
    if (value.IsBool()) return value.Get<bool>() ? kSheet : 0.0f;
    const double number = value.IsNumber() ? value.GetNumberAsDouble() : std::nan("");
    if (!(number >= 0.0 && number <= 1e5)) document_.fail(element, "retroreflective must be true, false or a number from 0 to 100000");
    return static_cast<float>(number);
  }

  void set_alpha(const tinygltf::Material& source, const std::string& element, Material& result) {
    if (source.alphaMode == "MASK") {
      result.alpha_mask = true;
      result.alpha_cutoff = in_range(source.alphaCutoff, 1e6, element, "alphaCutoff");
    } else if (source.alphaMode == "BLEND") {
      result.alpha_mask = true;
      result.alpha_cutoff = 0.5f;
      notes_.push_back(element + ": alphaMode BLEND is read as MASK at 0.5");
    } else if (source.alphaMode != "OPAQUE") {
      document_.fail(element, "alphaMode is neither OPAQUE, MASK nor BLEND");
    }
  }

  float in_range(double value, double max, const std::string& element, const char* key) const {
    if (!(value >= 0.0 && value <= max)) document_.fail(element, std::string(key) + " must lie between 0 and " + std::to_string(max));
    return static_cast<float>(value);
  }

  float factor(const std::vector<double>& values, std::size_t i, std::size_t count, double standard, double max, const std::string& element,
               const char* key) const {
    if (values.empty()) return static_cast<float>(standard);
    if (values.size() != count) document_.fail(element, std::string(key) + " must have " + std::to_string(count) + " numbers");
    return in_range(values[i], max, element, key);
  }

  template <class Info>
  TextureUse use(const Info& info, const std::string& element) {
    TextureUse result;
    if (info.index < 0) return result;
    result.texture = texture(info.index, element);
    result.uv_set = info.texCoord;
    const auto transform = info.extensions.find("KHR_texture_transform");
    if (transform != info.extensions.end()) set_transform(transform->second, element, result);
    if (result.uv_set != 0 && result.uv_set != 1) {
      notes_.push_back(element + ": a texture with TEXCOORD_" + std::to_string(result.uv_set) + " is read over; 0 and 1 are supported");
      result = {};
    }
    return result;
  }

  std::array<double, 2> pair(const tinygltf::Value& value, const std::string& element, const char* key) const {
    if (!value.IsArray() || value.ArrayLen() != 2)
      document_.fail(element, std::string("KHR_texture_transform.") + key + " must have 2 numbers");
    return {number_in(document_, value.Get(0), element, key, -1e6, 1e6), number_in(document_, value.Get(1), element, key, -1e6, 1e6)};
  }

  // Offset * rotation * scale. Positive rotation turns the coordinates counter-clockwise as seen with v pointing down, so that (1, 0) goes
  // to (cos, -sin): what the extension's text and its test model ask for.
  void set_transform(const tinygltf::Value& value, const std::string& element, TextureUse& result) const {
    std::array<double, 2> offset = {0, 0}, scale = {1, 1};
    double rotation = 0.0;
    if (const tinygltf::Value* v = member(value, "offset")) offset = pair(*v, element, "offset");
    if (const tinygltf::Value* v = member(value, "scale")) scale = pair(*v, element, "scale");
    if (const tinygltf::Value* v = member(value, "rotation")) rotation = number_in(document_, *v, element, "rotation", -1e6, 1e6);
    if (const tinygltf::Value* v = member(value, "texCoord")) {
      result.uv_set = static_cast<int>(number_in(document_, *v, element, "texCoord", 0, 1000));
    }
    const double c = std::cos(rotation), s = std::sin(rotation);
    Eigen::Matrix<double, 2, 3> m;
    m << c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1];
    result.uv_transform = m.cast<float>();
  }

  Texture::Wrap wrap(int mode, const std::string& element) const {
    switch (mode) {
      case TINYGLTF_TEXTURE_WRAP_REPEAT:
        return Texture::Wrap::kRepeat;
      case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Texture::Wrap::kClampToEdge;
      case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Texture::Wrap::kMirroredRepeat;
      default:
        document_.fail(element, "wrap mode " + std::to_string(mode) + " is not known");
    }
  }

  // Index into content.textures; pictures are decoded at first use and shared where the sampler agrees.
  int texture(int index, const std::string& used_by) {
    const tinygltf::Model& model = document_.model();
    if (static_cast<std::size_t>(index) >= model.textures.size()) {
      document_.fail(used_by, "names texture " + std::to_string(index) + " of " + std::to_string(model.textures.size()));
    }
    const tinygltf::Texture& source = model.textures[static_cast<std::size_t>(index)];
    const std::string element = element_name("texture", static_cast<std::size_t>(index), source.name);
    if (source.source < 0) {
      if (noted_.insert(index).second) notes_.push_back(element + ": has no picture that can be read; the material's factors stay");
      return -1;
    }
    if (static_cast<std::size_t>(source.source) >= document_.picture_count()) {
      document_.fail(element, "names image " + std::to_string(source.source) + " of " + std::to_string(document_.picture_count()));
    }
    tinygltf::Sampler sampler;
    if (source.sampler >= 0) {
      if (static_cast<std::size_t>(source.sampler) >= model.samplers.size()) {
        document_.fail(element, "names sampler " + std::to_string(source.sampler) + " of " + std::to_string(model.samplers.size()));
      }
      sampler = model.samplers[static_cast<std::size_t>(source.sampler)];
    }
    const Key key{source.source, sampler.wrapS, sampler.wrapT, sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST};
    const auto known = textures_.find(key);
    if (known != textures_.end()) return known->second;
    const std::size_t picture = static_cast<std::size_t>(source.source);
    const std::string& name = document_.picture_name(picture);
    Texture result = decode_picture(document_, document_.picture_bytes(picture), element_name("image", picture, name), pixels_);
    result.name = name;
    result.wrap_u = wrap(sampler.wrapS, element);
    result.wrap_v = wrap(sampler.wrapT, element);
    result.nearest = std::get<3>(key);
    content_.textures.push_back(std::move(result));
    return textures_[key] = static_cast<int>(content_.textures.size()) - 1;
  }

  using Key = std::tuple<int, int, int, bool>;  // picture, wraps, nearest

  const GltfDocument& document_;
  Scene& content_;
  std::vector<std::string>& notes_;
  std::map<Key, int> textures_;
  std::set<int> noted_;
  std::int64_t pixels_ = 0;
};

}  // namespace

void load_materials(const GltfDocument& document, Scene& content, std::vector<std::string>& notes) {
  MaterialLoader(document, content, notes).load();
}

}  // namespace waretwin
