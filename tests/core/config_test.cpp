#include "core/config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/files.h"
#include "core/random.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

struct Noise {
  std::string preset = "quiet";
  double sigma_m = 0.01;
  std::string shape = "gaussian";
  void visit(Fields& f) {
    const std::string before = preset;
    f("preset", preset, "starting point", {.choices = {"quiet", "loud"}});
    if (preset != before) sigma_m = preset == "loud" ? 0.5 : 0.01;
    f("sigma_m", sigma_m, "standard deviation", {.min = 0, .max = 1});
    f("shape", shape, "density", {.choices = {"gaussian", "none"}});
  }
};

struct Model {
  std::string name;
  std::filesystem::path file = "model.glb";
  double yaw_deg = 0;
  void visit(Fields& f) {
    f("name", name, "what to call it", {.required = true});
    f("file", file, "its model");
    f("yaw_deg", yaw_deg, "heading", {.min = -360, .max = 360});
  }
};

struct Sensor {
  double rate_hz = 10;
  Noise noise;
  void visit(Fields& f) {
    f("rate_hz", rate_hz, "measurements a second", {.min = 0.1, .max = 1000});
    f.group("noise", noise, "error model");
  }
};

struct Config {
  bool armed = true;
  int count = 3;
  std::int64_t stamp = 0;
  std::uint64_t seed = 1;
  double low_m = 0;
  double high_m = 1;
  std::string title = "hall";
  std::vector<double> position_m = {0, 0, 0};
  std::vector<std::string> classes;
  Noise noise;
  std::vector<Model> models;
  std::map<std::string, Sensor> sensors;

  void visit(Fields& f) {
    f("armed", armed, "a switch");
    f("count", count, "a number of things", {.min = 0, .max = 10});
    f("stamp", stamp, "nanoseconds");
    f("seed", seed, "random seed");
    f("low_m", low_m, "lower end");
    f("high_m", high_m, "upper end");
    if (high_m < low_m) f.reject("high_m", "is below low_m; expected at least as much");
    f("title", title, "any text");
    f("position_m", position_m, "x, y, z", {.min = -100, .max = 100, .length = 3});
    f("classes", classes, "class names");
    f.group("noise", noise, "error model");
    f.list("models", models, "what stands in the hall");
    f.map("sensors", sensors, "sensors by name");
  }
};

VisitFunction visitor(Config& config) {
  return [&config](Fields& f) { config.visit(f); };
}

Config read(const std::string& yaml) {
  Config config;
  read_config_text(yaml, "hall.yaml", visitor(config));
  return config;
}

Config with_settings(Config config, const std::vector<std::string>& settings) {
  std::vector<Setting> parsed;
  for (const std::string& text : settings) parsed.push_back(parse_setting(text));
  apply_settings(parsed, visitor(config));
  return config;
}

TEST(Config, ReadsEveryKindOfField) {
  const Config config = read(R"(
armed: off
count: 7
stamp: -9223372036854775808
seed: 18446744073709551615
low_m: -1.5e-3
high_m: +2
title: "null"
position_m: [1, -2.5, 3e1]
classes: [conveyor, "office chair"]
noise: {sigma_m: 0.25, shape: none}
models:
  - name: table
    file: models/table.glb
  - {name: arm, yaw_deg: 90}
sensors:
  camera:
    rate_hz: 15
    noise:
      preset: loud
)");
  EXPECT_FALSE(config.armed);
  EXPECT_EQ(config.count, 7);
  EXPECT_EQ(config.stamp, std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(config.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(config.low_m, -1.5e-3);
  EXPECT_EQ(config.high_m, 2.0);
  EXPECT_EQ(config.title, "null");
  EXPECT_EQ(config.position_m, (std::vector<double>{1, -2.5, 30}));
  EXPECT_EQ(config.classes, (std::vector<std::string>{"conveyor", "office chair"}));
  EXPECT_EQ(config.noise.sigma_m, 0.25);
  EXPECT_EQ(config.noise.shape, "none");
  ASSERT_EQ(config.models.size(), 2u);
  EXPECT_EQ(config.models[0].file, "models/table.glb");
  EXPECT_EQ(config.models[1].name, "arm");
  EXPECT_EQ(config.models[1].yaw_deg, 90);
  ASSERT_EQ(config.sensors.size(), 1u);
  EXPECT_EQ(config.sensors.at("camera").rate_hz, 15);
  EXPECT_EQ(config.sensors.at("camera").noise.sigma_m, 0.5);
}

TEST(Config, PresetGivesWayToKeysBesideItWhateverTheirOrder) {
  EXPECT_EQ(read("noise: {sigma_m: 0.1, preset: loud}").noise.sigma_m, 0.1);
  EXPECT_EQ(read("noise: {preset: loud}").noise.sigma_m, 0.5);
  EXPECT_EQ(with_settings({}, {"noise.sigma_m=0.1", "noise.preset=loud"}).noise.sigma_m, 0.1);
}

TEST(Config, EmptyFilesAndEmptyGroupsKeepDefaults) {
  for (const char* yaml : {"", "# only a comment\n", "---\n", "{}", "noise:\nmodels:\nsensors:\n"}) {
    EXPECT_EQ(read(yaml).noise.sigma_m, 0.01) << yaml;
    EXPECT_TRUE(read(yaml).models.empty()) << yaml;
  }
}

TEST(Config, UnknownKeyNamesPlaceAndNearestKey) {
  EXPECT_ERROR(read("count: 1\nnoise:\n  sgima_m: 0.1\n"), "hall.yaml:3:", "'noise.sgima_m' is not known", "did you mean 'sigma_m'?");
  EXPECT_ERROR(read("noise:\n  colour: red\n"), "hall.yaml:2:", "expected one of preset, sigma_m, shape");
  EXPECT_ERROR(read("models:\n  - name: a\n  - name: b\n    yaw_dg: 3\n"), "hall.yaml:4:", "'models.1.yaw_dg'", "'yaw_deg'");
  EXPECT_ERROR(read("sensors:\n  camera: {noise: {sigma: 1}}\n"), "'sensors.camera.noise.sigma'", "'sigma_m'");
  EXPECT_ERROR(read("titel: x"), "hall.yaml:1:", "did you mean 'title'?");
}

TEST(Config, MissingRequiredKeyIsReportedUnlessAMisspeltOneExplainsIt) {
  EXPECT_ERROR(read("models:\n  - yaw_deg: 3\n"), "hall.yaml:2:", "key 'models.0.name' is missing; expected text");
  EXPECT_ERROR(read("models:\n  - nane: table\n"), "'models.0.nane' is not known; did you mean 'name'?");
}

TEST(Config, WrongTypesNameValueAndExpectation) {
  EXPECT_ERROR(read("count: three"), "hall.yaml:1: key 'count' is 'three'; expected a whole number from 0 to 10");
  EXPECT_ERROR(read("count: 2.0"), "'2.0'", "a whole number");
  EXPECT_ERROR(read("count: 11"), "'11'", "from 0 to 10");
  EXPECT_ERROR(read("count: 99999999999999999999"), "a whole number from 0 to 10");
  EXPECT_ERROR(read("seed: -1"), "'-1'", "a whole number of at least 0");
  EXPECT_ERROR(read("armed: 1"), "true or false");
  EXPECT_ERROR(read("low_m: \"1\""), "in quotes", "a number");
  EXPECT_ERROR(read("low_m:"), "has no value; expected a number");
  EXPECT_ERROR(read("low_m: [1]"), "is a list of 1; expected a number");
  EXPECT_ERROR(read("low_m: 1_000"), "'1_000'");
  EXPECT_ERROR(read("low_m: +-1"), "'+-1'");
  EXPECT_ERROR(read("title: {a: 1}"), "is a group of keys; expected text");
  EXPECT_ERROR(read("title:"), "has no value; expected text");
  EXPECT_ERROR(read("noise: {sigma_m: 1.5}"), "key 'noise.sigma_m' is '1.5'; expected a number from 0 to 1");
  EXPECT_ERROR(read("noise: {shape: square}"), "'square'; expected one of gaussian, none");
  EXPECT_ERROR(read("noise: 3"), "key 'noise' is '3'; expected a group");
  EXPECT_ERROR(read("noise: [1]"), "key 'noise' is a list");
  EXPECT_ERROR(read("models: {name: x}"), "key 'models' is not a list");
  EXPECT_ERROR(read("models: [table]"), "key 'models.0' is 'table'; expected a group");
  EXPECT_ERROR(read("just words"), "hall.yaml:1: the file is 'just words'");
  EXPECT_ERROR(read("title: {a: 1}\ncount: x"), "key 'count'");
}

TEST(Config, VectorsAreHeldToLengthAndRange) {
  EXPECT_ERROR(read("position_m: [1, 2]"), "is a list of 2; expected a list of 3 numbers, each from -100 to 100");
  EXPECT_ERROR(read("position_m: [1, 2, 300]"), "holds a value that is '300'");
  EXPECT_ERROR(read("position_m: 1"), "is '1'; expected a list of 3 numbers");
  EXPECT_ERROR(read("classes: [a, [b]]"), "holds a value that is a list of 1; expected a list of words");
}

TEST(Config, NumbersThatAreNotFiniteAreRefused) {
  for (const char* text : {".nan", ".inf", "-.inf", "nan", "inf", "1e999"}) {
    EXPECT_ERROR(read(std::string("low_m: ") + text), "expected a number");
    EXPECT_ERROR(with_settings({}, {std::string("low_m=") + text}), "--set low_m:", "expected a number");
  }
}

TEST(Config, CrossChecksReportTheLineOfTheirKey) {
  EXPECT_ERROR(read("low_m: 2\n\nhigh_m: 1\n"), "hall.yaml:3: key 'high_m' is below low_m");
  EXPECT_ERROR(read("count: 1\nlow_m: 2\n"), "key 'high_m' is below low_m");
  EXPECT_ERROR(with_settings({}, {"high_m=-1"}), "--set high_m: is below low_m");
  EXPECT_ERROR(with_settings({}, {"low_m=2"}), "after --set: key 'high_m' is below low_m");
}

TEST(Config, DamagedDocumentsEndInOneLine) {
  EXPECT_ERROR(read("count: 1\ncount: 2\n"), "hall.yaml:2:", "'count' stands here a second time");
  EXPECT_ERROR(read("noise: {sigma_m: 1, sigma_m: 2}"), "second time");
  EXPECT_ERROR(read("noise: {sigma_m: 1"), "hall.yaml:", "not valid YAML");
  EXPECT_ERROR(read("count: 1\n\ttitle: x\n"), "hall.yaml:", "not valid YAML");
  EXPECT_ERROR(read("title: \"open"), "not valid YAML");
  EXPECT_ERROR(read("count: 1\n---\ncount: 2\n"), "second YAML document");
  EXPECT_ERROR(read("? [a, b]\n: 1\n"), "key that is not a word");
  EXPECT_ERROR(read("noise: &n {preset: *n}"), "anchor contains itself");
  EXPECT_ERROR(read("title: *nowhere"), "not valid YAML");
  EXPECT_ERROR(read("noise: " + std::string(40, '[') + std::string(40, ']')), "more than 32 levels");
  EXPECT_ERROR(read("noise: " + std::string(100000, '[')), "more than 32 levels");
  std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 40; ++i) {
    laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) laughs += (k ? ", *a" : "*a") + std::to_string(i - 1);
    laughs += "]\n";
  }
  EXPECT_ERROR(read(laughs), "more than 32 levels");
}

TEST(Config, AnchorsAreShared) {
  const Config config = read("noise: &n {preset: loud}\nsensors: {left: {noise: *n}, right: {noise: *n}}\n");
  EXPECT_EQ(config.sensors.at("left").noise.sigma_m, 0.5);
  EXPECT_EQ(config.sensors.at("right").noise.sigma_m, 0.5);
}

TEST(Config, FilesAreReadAndMissingOnesNamed) {
  const test::TemporaryFolder folder;
  write_file(folder.path() / "hall.yaml", "count: 4\nbogus: 1\n");
  Config config;
  EXPECT_ERROR(read_config_into(folder.path() / "hall.yaml", config), "hall.yaml:2:", "bogus");
  EXPECT_ERROR(read_config_into(folder.path() / "none.yaml", config), "none.yaml: no such file");
}

TEST(Config, FileListReplacesDefaultAndFileNamesJoinDefaultOnes) {
  Config config;
  config.models.resize(3);
  config.sensors["laser"].rate_hz = 25;
  read_config_text("models: [{name: one}]\nsensors: {camera: {rate_hz: 5}}\n", "hall.yaml", visitor(config));
  EXPECT_EQ(config.models.size(), 1u);
  EXPECT_EQ(config.sensors.at("laser").rate_hz, 25);
  EXPECT_EQ(config.sensors.at("camera").rate_hz, 5);
}

Config filled() {
  Config config;
  config.models.resize(2);
  config.models[0].name = "table";
  config.models[1].name = "arm";
  config.sensors["camera"].rate_hz = 15;
  return config;
}

TEST(Settings, ReachEveryPlace) {
  const Config config = with_settings(
      filled(), {"count=5", "models.1.yaw_deg=-30", "sensors.camera.noise.preset=loud", "position_m=[1, 2, 3]", "classes=[a, b]",
                 "title=a: b #3", "models.0.file=dir/x.glb", "count=6", "armed=false", "seed=18446744073709551615"});
  EXPECT_EQ(config.count, 6);
  EXPECT_EQ(config.models[1].yaw_deg, -30);
  EXPECT_EQ(config.sensors.at("camera").noise.sigma_m, 0.5);
  EXPECT_EQ(config.position_m, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(config.classes, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(config.title, "a: b #3");
  EXPECT_EQ(config.models[0].file, "dir/x.glb");
  EXPECT_FALSE(config.armed);
  EXPECT_EQ(config.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(config.low_m, 0.0);
  EXPECT_EQ(with_settings(filled(), {"title="}).title, "");
  EXPECT_EQ(with_settings(filled(), {"title=\"in \\\"quotes\\\"\""}).title, "in \"quotes\"");
}

TEST(Settings, UnknownKeysNameTheNearest) {
  EXPECT_ERROR(with_settings(filled(), {"noise.sigma=1"}), "--set noise.sigma: no such key; did you mean 'noise.sigma_m'?");
  EXPECT_ERROR(with_settings(filled(), {"sensors.camara.rate_hz=1"}), "did you mean 'sensors.camera.rate_hz'?");
  EXPECT_ERROR(with_settings(filled(), {"rate_hz=1"}), "did you mean 'sensors.camera.rate_hz'?");
  EXPECT_ERROR(with_settings(filled(), {"noise=1"}), "is a group; expected the path of a single value");
  EXPECT_ERROR(with_settings(filled(), {"models.12345678.abcdefgh=1"}), "'models' is a list of 2, counted from 0");
  EXPECT_ERROR(with_settings(filled(), {"noise.xyzxyzxyzxyz=1"}), "expected one of preset, sigma_m, shape");
  EXPECT_ERROR(with_settings(filled(), {"qqqqqqqqqqqqq=1"}), "expected one of armed, count");
}

TEST(Settings, BadValuesNameTheirKey) {
  EXPECT_ERROR(with_settings(filled(), {"count=many"}), "--set count: is 'many'; expected a whole number from 0 to 10");
  EXPECT_ERROR(with_settings(filled(), {"count="}), "--set count: has no value");
  EXPECT_ERROR(with_settings(filled(), {"position_m=[1, 2"}), "--set position_m", "not valid YAML");
  EXPECT_ERROR(parse_setting("no_equals_sign"), "'no_equals_sign'", "expected key=value");
  EXPECT_ERROR(parse_setting("=3"), "expected key=value");
}

bool same_values(const Config& a, const Config& b) {
  Config copy_a = a;
  Config copy_b = b;
  return write_config(visitor(copy_a)) == write_config(visitor(copy_b)) && a.low_m == b.low_m && a.title == b.title &&
         a.position_m == b.position_m && a.classes == b.classes && a.models.size() == b.models.size() &&
         a.sensors.size() == b.sensors.size();
}

TEST(ConfigWriter, WritesReadableYaml) {
  Config config = filled();
  config.classes = {"conveyor", "true", "3"};
  config.high_m = 0.1;
  EXPECT_EQ(write_config(visitor(config)), R"(armed: true
count: 3
stamp: 0
seed: 1
low_m: 0
high_m: 0.1
title: hall
position_m: [0, 0, 0]
classes: [conveyor, "true", "3"]
noise:
  preset: quiet
  sigma_m: 0.01
  shape: gaussian
models:
  - name: table
    file: model.glb
    yaw_deg: 0
  - name: arm
    file: model.glb
    yaw_deg: 0
sensors:
  camera:
    rate_hz: 15
    noise:
      preset: quiet
      sigma_m: 0.01
      shape: gaussian
)");
}

TEST(ConfigWriter, ReadsBackIdentically) {
  const RandomStream random(7, "test", "config");
  const std::string letters = "abc XYZ019:#-'\"\\{}[],&*!|>%@`~?\n\t\x01\x7f\xc3\xa9.";
  for (std::uint64_t round = 0; round < 300; ++round) {
    Config config;
    std::uint32_t draw = 0;
    const auto number = [&] {
      // Every exponent, not only numbers near 1.
      const auto words = random.words(round, draw++);
      return std::ldexp(static_cast<double>(words[0]) - 2147483648.0 + static_cast<double>(words[1]) * 0x1p-32,
                        static_cast<int>(words[2] % 1900) - 1000);
    };
    const auto text = [&] {
      std::string out;
      const std::uint32_t length = random.words(round, draw++)[0] % 12;
      for (std::uint32_t i = 0; i < length; ++i) out += letters[random.words(round, draw++)[0] % (letters.size() - 3)];
      return out;
    };
    config.low_m = number();
    config.high_m = std::abs(config.low_m) * 1.5;
    config.title = text();
    config.position_m = {100 * random.uniform(round, draw++), -0.0, 1e-300};
    config.classes = {text(), text()};
    config.models.resize(random.words(round, draw++)[0] % 3);
    for (Model& model : config.models) model.name = text();
    config.sensors["s" + text()].rate_hz = 17;
    config.seed = static_cast<std::uint64_t>(random.words(round, draw++)[0]) << 32;
    const std::string yaml = write_config(visitor(config));
    Config back;
    ASSERT_NO_THROW(read_config_text(yaml, "back.yaml", visitor(back))) << yaml;
    ASSERT_TRUE(same_values(config, back)) << yaml;
  }
}

TEST(ConfigWriter, EmptyGroupsReadBack) {
  struct Nothing {
    void visit(Fields&) {}
  };
  struct Holder {
    Nothing nothing;
    std::vector<Nothing> some = std::vector<Nothing>(2);
    std::map<std::string, Nothing> named;
    void visit(Fields& f) {
      f.group("nothing", nothing, "");
      f.list("some", some, "");
      f.map("named", named, "");
    }
  } holder;
  holder.named["a b"] = {};
  const std::string yaml = write_config([&](Fields& f) { holder.visit(f); });
  EXPECT_EQ(yaml, "nothing: {}\nsome:\n  - {}\n  - {}\nnamed:\n  a b: {}\n");
  Holder back;
  read_config_text(yaml, "x.yaml", [&](Fields& f) { back.visit(f); });
  EXPECT_EQ(back.named.count("a b"), 1u);
}

TEST(ConfigDescription, NamesEveryFieldOnce) {
  Config config;
  const std::string text = describe_config(visitor(config));
  EXPECT_NE(text.find("count: a number of things (a whole number from 0 to 10; default 3)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("models.N.name: what to call it (text, required)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("sensors.NAME.noise.sigma_m: standard deviation (a number from 0 to 1; default 0.01)\n"), std::string::npos) << text;
}

TEST(NearestKey, FindsTypingErrorsAndNothingElse) {
  const std::vector<std::string> known = {"speed", "start", "route", "yaw"};
  EXPECT_EQ(nearest_key("speeed", known), "speed");
  EXPECT_EQ(nearest_key("spede", known), "speed");
  EXPECT_EQ(nearest_key("rout", known), "route");
  EXPECT_EQ(nearest_key("yav", known), "yaw");
  EXPECT_EQ(nearest_key("colour", known), "");
  EXPECT_EQ(nearest_key("", known), "");
  EXPECT_EQ(nearest_key("speed", {}), "");
  EXPECT_EQ(nearest_key(std::string(100000, 's'), known), "");
}

}  // namespace
}  // namespace waretwin
