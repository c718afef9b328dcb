// Guards the arrows between the rooms: core <- sensors <- scenes <- sim; core, sensors <- mapper; harness sees all. Reads the #include
// lines of every source and the link lines of every room's CMake files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/files.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>>& allowed() {
  static const std::map<std::string, std::set<std::string>> rooms = {
      {"core", {"core"}},
      {"sensors", {"core", "sensors"}},
      {"scenes", {"core", "sensors", "scenes"}},
      {"sim", {"core", "sensors", "scenes", "sim"}},
      {"mapper", {"core", "sensors", "mapper"}},
      {"harness", {"core", "sensors", "scenes", "sim", "mapper", "harness"}},
  };
  return rooms;
}

bool is_source(const fs::path& file) {
  const std::set<std::string> endings = {".h", ".hpp", ".inl", ".cpp", ".cc", ".cxx"};
  return endings.count(file.extension().string()) != 0;
}

bool is_cmake(const fs::path& file) { return file.filename() == "CMakeLists.txt" || file.extension() == ".cmake"; }

// The path inside quotes or angle brackets of an include line; empty for other lines.
std::string included_path(const std::string& line) {
  std::size_t i = 0;
  const auto skip_blanks = [&] {
    while (i < line.size() && std::isspace(static_cast<unsigned char>(line[i]))) ++i;
  };
  skip_blanks();
  if (i == line.size() || line[i] != '#') return "";
  ++i;
  skip_blanks();
  if (line.compare(i, 7, "include") != 0) return "";
  i += 7;
  skip_blanks();
  if (i == line.size() || (line[i] != '"' && line[i] != '<')) return "";
  const std::size_t end = line.find(line[i] == '"' ? '"' : '>', i + 1);
  return end == std::string::npos ? "" : line.substr(i + 1, end - i - 1);
}

// Which room a path from the root belongs to, the including file's folder being tried as well; empty for packages.
std::string room_of(const fs::path& root, const fs::path& including_file, const std::string& path) {
  const fs::path beside = (including_file.parent_path() / path).lexically_normal().lexically_relative(root.lexically_normal());
  if (path.find("..") != std::string::npos && !beside.empty()) return beside.begin()->string();
  const std::string first = fs::path(path).begin()->string();
  return fs::path(path).has_parent_path() ? first : "";
}

struct Finding {
  std::vector<std::string> wrong;
  int includes = 0;  // of rooms' headers
  int links = 0;     // of rooms' libraries
};

void check_source(const fs::path& root, const std::string& room, const fs::path& file, Finding& finding) {
  std::istringstream in(read_file(file));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string path = included_path(line);
    if (path.empty()) continue;
    const std::string target = room_of(root, file, path);
    if (allowed().count(target) == 0 && target != "tests") continue;
    ++finding.includes;
    if (allowed().at(room).count(target) == 0) {
      finding.wrong.push_back(fs::relative(file, root).string() + ":" + std::to_string(number) + ": " + room + " includes " + path);
    }
  }
}

// Every waretwin::ROOM or waretwin_ROOM in a room's CMake files, comments left out.
void check_cmake(const fs::path& root, const std::string& room, const fs::path& file, Finding& finding) {
  std::istringstream in(read_file(file));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find('#'));
    for (const std::string head : {"waretwin::", "waretwin_"}) {
      for (std::size_t at = line.find(head); at != std::string::npos; at = line.find(head, at + 1)) {
        std::size_t end = at + head.size();
        while (end < line.size() && (std::isalnum(static_cast<unsigned char>(line[end])) || line[end] == '_')) ++end;
        const std::string target = line.substr(at + head.size(), end - at - head.size());
        if (allowed().count(target) == 0) continue;
        ++finding.links;
        if (allowed().at(room).count(target) == 0) {
          finding.wrong.push_back(fs::relative(file, root).string() + ":" + std::to_string(number) + ": " + room + " links " + target);
        }
      }
    }
  }
}

Finding check_rooms(const fs::path& root) {
  Finding finding;
  for (const auto& entry : allowed()) {
    const std::string& room = entry.first;
    if (!fs::exists(root / room)) continue;
    for (const auto& file : fs::recursive_directory_iterator(root / room)) {
      if (!file.is_regular_file()) continue;
      if (is_source(file.path())) check_source(root, room, file.path(), finding);
      if (is_cmake(file.path())) check_cmake(root, room, file.path(), finding);
    }
  }
  std::sort(finding.wrong.begin(), finding.wrong.end());
  return finding;
}

TEST(Arrows, NoRoomSeesWhatItMustNot) {
  const Finding finding = check_rooms(test::repository());
  std::string text;
  for (const std::string& wrong : finding.wrong) text += "\n  " + wrong;
  EXPECT_TRUE(finding.wrong.empty()) << text;
  // The checker has read the rooms and not an empty folder.
  EXPECT_GT(finding.includes, 50);
  EXPECT_GT(finding.links, 4);
  for (const auto& room : allowed()) EXPECT_TRUE(fs::is_directory(test::repository() / room.first)) << room.first;
}

class MadeUpTree : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    make_folder((folder_.path() / name).parent_path());
    write_file(folder_.path() / name, text);
  }
  Finding check() const { return check_rooms(folder_.path()); }

  test::TemporaryFolder folder_;
};

TEST_F(MadeUpTree, EveryForbiddenArrowIsCaughtAndEveryAllowedOnePasses) {
  for (const auto& [room, targets] : allowed()) {
    for (const auto& other : allowed()) {
      write(room + "/probe.cpp", "#include \"" + other.first + "/x.h\"\n");
      const Finding finding = check();
      EXPECT_EQ(finding.includes, 1);
      EXPECT_EQ(finding.wrong.empty(), targets.count(other.first) != 0) << room << " -> " << other.first;
      if (!finding.wrong.empty()) {
        EXPECT_EQ(finding.wrong.front(), room + "/probe.cpp:1: " + room + " includes " + other.first + "/x.h");
      }
      fs::remove(folder_.path() / room / "probe.cpp");
    }
  }
}

TEST_F(MadeUpTree, HiddenFormsAreCaught) {
  write("mapper/segment/a.h", "// text\n\n  #  include   \"scenes/scene.h\"\n");
  write("mapper/b.cpp", "#include <sim/ray_caster.h>\n");
  write("mapper/c.cc", "#include \"../sim/ray_caster.h\"\n");
  write("core/d.h", "#include \"tests/support/test_data.h\"\n");
  const std::vector<std::string> expected = {
      "core/d.h:1: core includes tests/support/test_data.h", "mapper/b.cpp:1: mapper includes sim/ray_caster.h",
      "mapper/c.cc:1: mapper includes ../sim/ray_caster.h", "mapper/segment/a.h:3: mapper includes scenes/scene.h"};
  EXPECT_EQ(check().wrong, expected);
}

TEST_F(MadeUpTree, PackagesAndNeighboursPass) {
  write("mapper/a.cpp",
        "#include <vector>\n#include <pcl/point_types.h>\n#include \"mapper/b.h\"\n#include \"b.h\"\n// #include \"sim/x.h\"\n");
  write("mapper/b/c.h", "#include \"../b.h\"\n");
  EXPECT_TRUE(check().wrong.empty());
}

TEST_F(MadeUpTree, ForbiddenLinksAreCaught) {
  write("mapper/CMakeLists.txt",
        "# waretwin::sim in a comment\nwaretwin_room(mapper\n  PUBLIC waretwin::core waretwin::sensors\n  PRIVATE waretwin::sim)\n");
  write("mapper/more.cmake", "target_link_libraries(waretwin_mapper PRIVATE waretwin_scenes)\n");
  write("scenes/CMakeLists.txt", "waretwin_room(scenes PUBLIC waretwin::core PRIVATE waretwin::tinygltf)\n");
  const std::vector<std::string> expected = {"mapper/CMakeLists.txt:4: mapper links sim", "mapper/more.cmake:1: mapper links scenes"};
  EXPECT_EQ(check().wrong, expected);
}

}  // namespace
}  // namespace waretwin
