// waretwin_build_halls OUT_FOLDER [agiprobot|warehouse|flat]: writes the models of one hall or all to OUT_FOLDER/HALL.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "scenes/builder/halls.h"

int main(int argc, char** argv) {
  using namespace waretwin;
  if (argc < 2 || argc > 3 || std::string(argv[1]).starts_with("-")) {
    std::fprintf(stderr,
                 "usage: waretwin_build_halls OUT_FOLDER [agiprobot|warehouse|flat]\nexample: waretwin_build_halls scenes agiprobot\n");
    return 2;
  }
  try {
    const std::vector<std::string> names = argc == 3 ? std::vector<std::string>{argv[2]} : builder::hall_names();
    for (const std::string& name : names) {
      const std::vector<builder::HallFile> files = builder::build_hall(name);
      const std::filesystem::path folder = std::filesystem::path(argv[1]) / name;
      make_folder(folder);
      for (const builder::HallFile& file : files) {
        write_file(folder / file.name, file.glb);
        std::printf("%s: %zu bytes\n", (folder / file.name).c_str(), file.glb.size());
      }
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "waretwin_build_halls: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "waretwin_build_halls: %s\n", error.what());
    return 3;
  }
  return 0;
}
