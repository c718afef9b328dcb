# Every third-party package, found once. ci/install.sh names the Debian packages they come from.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(embree 3 REQUIRED)
find_package(OpenCV 4 REQUIRED COMPONENTS core imgproc imgcodecs dnn calib3d)
find_package(PCL 1.12 QUIET REQUIRED COMPONENTS common kdtree search features filters segmentation)
find_package(ZLIB REQUIRED)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
if(WARETWIN_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()

# PCL's own variables carry no target and define preprocessor words for everyone: wrap them once.
add_library(waretwin_pcl INTERFACE)
add_library(waretwin::pcl ALIAS waretwin_pcl)
target_include_directories(waretwin_pcl SYSTEM INTERFACE ${PCL_INCLUDE_DIRS})
target_link_libraries(waretwin_pcl INTERFACE ${PCL_LIBRARIES})

add_library(waretwin_opencv INTERFACE)
add_library(waretwin::opencv ALIAS waretwin_opencv)
target_include_directories(waretwin_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(waretwin_opencv INTERFACE opencv_core opencv_imgproc opencv_imgcodecs)

add_library(waretwin_opencv_dnn INTERFACE)
add_library(waretwin::opencv_dnn ALIAS waretwin_opencv_dnn)
target_link_libraries(waretwin_opencv_dnn INTERFACE waretwin::opencv opencv_dnn)

add_library(waretwin_embree INTERFACE)
add_library(waretwin::embree ALIAS waretwin_embree)
target_link_libraries(waretwin_embree INTERFACE embree)

# Bullet in double precision: Debian builds both, but its package configuration names the single one alone.
add_library(waretwin_bullet INTERFACE)
add_library(waretwin::bullet ALIAS waretwin_bullet)
find_path(BULLET_INCLUDE_DIR btBulletDynamicsCommon.h PATH_SUFFIXES bullet REQUIRED)
target_include_directories(waretwin_bullet SYSTEM INTERFACE ${BULLET_INCLUDE_DIR})
target_compile_definitions(waretwin_bullet INTERFACE BT_USE_DOUBLE_PRECISION)
foreach(part BulletDynamics BulletCollision LinearMath)
  find_library(WARETWIN_${part} ${part}-float64 REQUIRED)
  target_link_libraries(waretwin_bullet INTERFACE ${WARETWIN_${part}})
endforeach()

add_library(waretwin_tinygltf INTERFACE)
add_library(waretwin::tinygltf ALIAS waretwin_tinygltf)
# The package ships the compiled library; its header still wants nlohmann-json.
target_link_libraries(waretwin_tinygltf INTERFACE TinyGLTF::TinyGLTF nlohmann_json::nlohmann_json)
