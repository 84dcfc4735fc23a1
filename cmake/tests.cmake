# One executable for each folder that holds tests: tests/LABEL/[ROOM/]NAME_test.cpp -> test_LABEL[_ROOM].
find_package(GTest REQUIRED)
include(GoogleTest)

# Half of what compilers do for a test is GoogleTest's and the library's headers. Not beside ccache, which would miss,
# nor in the sanitizers' presets, where a test that lacks an include shows.
if(NOT DEFINED BRICKFIELD_PRECOMPILE)
  if(CCACHE OR BRICKFIELD_SANITIZE)
    set(BRICKFIELD_PRECOMPILE OFF)
  else()
    set(BRICKFIELD_PRECOMPILE ON)
  endif()
endif()
if(BRICKFIELD_PRECOMPILE)
  # Of headers that come precompiled GCC 12 forgets that they are the system's, and shows what it takes for faults there.
  add_compile_options(-Wno-array-bounds -Wno-maybe-uninitialized -Wno-restrict -Wno-stringop-overflow
                      -Wno-stringop-overread)
endif()

# Tests wait for what they test: to optimize them takes longer than they gain.
add_compile_options($<$<CONFIG:Release>:-O1>)

file(GLOB SUPPORT_SOURCES CONFIGURE_DEPENDS tests/support/*.cpp)
if(SUPPORT_SOURCES)
  add_library(brickfield_test_support STATIC ${SUPPORT_SOURCES})
  target_link_libraries(brickfield_test_support PUBLIC brickfield_app GTest::gtest GTest::gmock)
  target_compile_definitions(brickfield_test_support PUBLIC BRICKFIELD_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                             BRICKFIELD_BINARY_DIR="${CMAKE_BINARY_DIR}")
  target_include_directories(brickfield_test_support PUBLIC ${CMAKE_SOURCE_DIR})
  if(BRICKFIELD_PRECOMPILE)
    target_precompile_headers(brickfield_test_support PRIVATE tests/precompiled.h)
  endif()
endif()

set(CTEST_TIMEOUT_SECONDS 300)
if(BRICKFIELD_SANITIZE)
  set(CTEST_TIMEOUT_SECONDS 1200)
endif()
foreach(LABEL unit gpu oracle render bake robustness)
  file(GLOB_RECURSE TEST_SOURCES CONFIGURE_DEPENDS tests/${LABEL}/*_test.cpp)
  set(FOLDERS "")
  foreach(SOURCE ${TEST_SOURCES})
    get_filename_component(FOLDER ${SOURCE} DIRECTORY)
    list(APPEND FOLDERS ${FOLDER})
  endforeach()
  list(REMOVE_DUPLICATES FOLDERS)
  foreach(FOLDER ${FOLDERS})
    file(GLOB FOLDER_SOURCES CONFIGURE_DEPENDS ${FOLDER}/*_test.cpp)
    file(RELATIVE_PATH NAME ${CMAKE_SOURCE_DIR}/tests ${FOLDER})
    string(REPLACE "/" "_" NAME ${NAME})
    add_executable(test_${NAME} ${FOLDER_SOURCES})
    target_link_libraries(test_${NAME} PRIVATE brickfield_test_support GTest::gtest_main)
    if(BRICKFIELD_PRECOMPILE)
      target_precompile_headers(test_${NAME} REUSE_FROM brickfield_test_support)
    endif()
    gtest_discover_tests(test_${NAME} TEST_PREFIX ${NAME}. DISCOVERY_TIMEOUT 120
                         PROPERTIES LABELS ${LABEL} TIMEOUT ${CTEST_TIMEOUT_SECONDS})
  endforeach()
endforeach()
# GCC 12 takes the insides of its own std::regex for uninitialized when it instruments them.
if(BRICKFIELD_SANITIZE)
  set_source_files_properties(tests/gpu/passes/every_shader_compiles_test.cpp tests/bake/bakers/bake_memory_test.cpp
                              PROPERTIES COMPILE_OPTIONS -Wno-maybe-uninitialized)
endif()
if(TARGET brickfield_test_support)
  add_dependencies(brickfield_test_support brickfield)
endif()
if(TARGET test_unit_scenes)
  add_dependencies(test_unit_scenes brickfield_scenes)
endif()

file(GLOB LINT_SCRIPTS CONFIGURE_DEPENDS tests/lint/*.sh)
foreach(SCRIPT ${LINT_SCRIPTS})
  get_filename_component(NAME ${SCRIPT} NAME_WE)
  add_test(NAME lint.${NAME} COMMAND bash ${SCRIPT} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  set_tests_properties(lint.${NAME} PROPERTIES LABELS lint TIMEOUT 600)
endforeach()
