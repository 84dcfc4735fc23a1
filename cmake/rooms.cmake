# One static library a room, linked only to the rooms of lower rank (tools/check_layers proves the includes).
find_package(PkgConfig REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(Threads REQUIRED)
find_package(glfw3 REQUIRED)
find_package(CLI11 CONFIG QUIET)
find_package(nlohmann_json REQUIRED)
find_package(TinyGLTF REQUIRED)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)

function(brickfield_room NAME DIRECTORY)
  file(GLOB_RECURSE SOURCES CONFIGURE_DEPENDS ${DIRECTORY}/*.cpp)
  list(FILTER SOURCES EXCLUDE REGEX "/main\\.cpp$")
  if(NOT SOURCES)
    add_library(brickfield_${NAME} INTERFACE)
    target_include_directories(brickfield_${NAME} INTERFACE ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR}/shaders ${CMAKE_SOURCE_DIR})
    target_link_libraries(brickfield_${NAME} INTERFACE ${ARGN})
  else()
    add_library(brickfield_${NAME} STATIC ${SOURCES})
    target_include_directories(brickfield_${NAME} PUBLIC ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR}/shaders ${CMAKE_SOURCE_DIR})
    target_link_libraries(brickfield_${NAME} PUBLIC ${ARGN})
  endif()
endfunction()

brickfield_room(core src/core fmt::fmt PkgConfig::XXHASH Threads::Threads)
brickfield_room(field src/field brickfield_core PkgConfig::ZSTD)
# Codes of samples are made four at a time.
set_source_files_properties(src/field/brick_layout.cpp PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
brickfield_room(gpu src/gpu brickfield_core PkgConfig::EPOXY PkgConfig::EGL glfw)
brickfield_room(scene src/scene brickfield_field brickfield_core nlohmann_json::nlohmann_json TinyGLTF::TinyGLTF)
brickfield_room(resident src/resident brickfield_scene brickfield_gpu)
brickfield_room(passes src/passes brickfield_resident)
brickfield_room(renderer src/renderer brickfield_passes)

if(BRICKFIELD_BAKERS)
  find_package(embree 3 REQUIRED)
  find_package(TBB REQUIRED)
  find_package(OpenImageIO REQUIRED)
  # Debian's package names the folder of OpenCV's headers, which nobody here needs.
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${OpenImageIO_INCLUDE_DIR}")
  brickfield_room(bakers bakers brickfield_scene embree TBB::tbb OpenImageIO::OpenImageIO)
  # Bakes are loops over samples: a tenth faster than with -O2, the same bytes.
  target_compile_options(brickfield_bakers PRIVATE $<$<CONFIG:Release>:-O3>)
  # A peer for `bench bake` alone; without it that column says so. Its headers need Boost's.
  find_path(OPENVDB_INCLUDE openvdb/tools/MeshToVolume.h)
  find_path(BOOST_NUMERIC_INCLUDE boost/numeric/conversion/conversion_traits.hpp)
  find_library(OPENVDB_LIBRARY openvdb)
  if(OPENVDB_INCLUDE AND BOOST_NUMERIC_INCLUDE AND OPENVDB_LIBRARY AND NOT BRICKFIELD_SANITIZE)
    # As its own packages are built: optimised, without assertions.
    set_source_files_properties(bakers/openvdb_band.cpp PROPERTIES
                                COMPILE_OPTIONS "-O3;-w" COMPILE_DEFINITIONS "BRICKFIELD_OPENVDB;NDEBUG")
    target_link_libraries(brickfield_bakers PUBLIC ${OPENVDB_LIBRARY} Imath::Imath)
  endif()
endif()

file(GLOB APP_SOURCES CONFIGURE_DEPENDS src/app/*.cpp)
list(FILTER APP_SOURCES EXCLUDE REGEX "/main\\.cpp$")
add_library(brickfield_app STATIC ${APP_SOURCES})
set_source_files_properties(src/app/command_line.cpp PROPERTIES
                            COMPILE_DEFINITIONS BRICKFIELD_VERSION="${PROJECT_VERSION}")
# Of each file that reads options CLI11's own code takes the optimizer 4 s.
file(GLOB OPTION_SOURCES src/app/command_*.cpp src/app/*_choice.cpp src/app/options.cpp)
set_property(SOURCE ${OPTION_SOURCES} APPEND PROPERTY COMPILE_OPTIONS $<$<CONFIG:Release>:-O1>)
target_link_libraries(brickfield_app PUBLIC brickfield_renderer spdlog::spdlog nlohmann_json::nlohmann_json)
if(BRICKFIELD_BAKERS)
  target_link_libraries(brickfield_app PUBLIC brickfield_bakers)
  target_compile_definitions(brickfield_app PUBLIC BRICKFIELD_BAKERS=1)
else()
  # What finds baked bricks in the cache needs no Embree.
  target_sources(brickfield_app PRIVATE bakers/bake_input.cpp bakers/bake_cache.cpp)
endif()
add_executable(brickfield src/app/main.cpp)
target_link_libraries(brickfield PRIVATE brickfield_app)

# Shaders are read from the folder beside the binary: here a link, in a bundle a copy.
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/shaders ${CMAKE_BINARY_DIR}/shaders SYMBOLIC)

file(GLOB SCENE_SOURCES CONFIGURE_DEPENDS scenes/*.cpp)
if(SCENE_SOURCES)
  add_executable(brickfield_scenes ${SCENE_SOURCES})
  pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)
  target_link_libraries(brickfield_scenes PRIVATE brickfield_core nlohmann_json::nlohmann_json PkgConfig::STB)
endif()
