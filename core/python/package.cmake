# The package `freeplay` in the folder python of the build: _core from here, the rest as it stands in core/python/freeplay.
execute_process(COMMAND ${FREEPLAY_INTERPRETER} -c "import sysconfig; print(sysconfig.get_path('include'), sysconfig.get_config_var('EXT_SUFFIX'), sep=';', end='')"
                OUTPUT_VARIABLE interpreter COMMAND_ERROR_IS_FATAL ANY)
list(GET interpreter 0 interpreter_include)
list(GET interpreter 1 extension_suffix)
find_path(PYTHON_INCLUDE Python.h PATHS ${interpreter_include} NO_DEFAULT_PATH REQUIRED)
find_path(PYBIND11_INCLUDE pybind11/pybind11.h REQUIRED)
set(python_package ${CMAKE_BINARY_DIR}/python/freeplay)

file(GLOB sources CONFIGURE_DEPENDS core/python/*.cpp)
add_library(freeplay_python MODULE ${sources})
freeplay_compile_together(freeplay_python)
# Headers of the interpreter take long to compile: what needs them makes one unit, all else another. What is there for
# others must be seen by no other file.
list(FILTER sources EXCLUDE REGEX "/outside_[a-z]*\\.cpp$")
set_target_properties(freeplay_python PROPERTIES UNITY_BUILD_MODE GROUP)
set_source_files_properties(${sources} PROPERTIES UNITY_GROUP rest)
set_source_files_properties(core/python/module.cpp core/python/binding.cpp core/python/run_binding.cpp core/python/map_binding.cpp
                            PROPERTIES UNITY_GROUP binding)
set_target_properties(freeplay_python PROPERTIES PREFIX "" SUFFIX ${extension_suffix} OUTPUT_NAME _core
                                                 LIBRARY_OUTPUT_DIRECTORY ${python_package}
                                                 LINK_DEPENDS ${PROJECT_SOURCE_DIR}/core/python/exported.map)
target_include_directories(freeplay_python SYSTEM PRIVATE ${PYBIND11_INCLUDE} ${PYTHON_INCLUDE})
target_compile_definitions(freeplay_python PRIVATE FREEPLAY_BUILD="${CMAKE_BUILD_TYPE}")
target_compile_options(freeplay_python PRIVATE $<$<CONFIG:Release>:-Os>)
# HDF5 is loaded when it is needed; expat is there with the interpreter.
find_library(HDF5_SHARED NAMES hdf5_serial hdf5 REQUIRED)
get_filename_component(hdf5_library ${HDF5_SHARED} REALPATH)
get_filename_component(hdf5_library ${hdf5_library} NAME)
string(REGEX MATCH "^[a-z0-9_]+\\.so\\.[0-9]+" hdf5_library ${hdf5_library})
string(REGEX REPLACE ".*\\.so\\.([0-9]+)$" "libhdf5-\\1-1" hdf5_package ${hdf5_library})
set(outside_hdf5 ${CMAKE_BINARY_DIR}/generated/outside_hdf5.cpp)
add_custom_command(OUTPUT ${outside_hdf5} DEPENDS freeplay_results core/python/outside_hdf5.py VERBATIM
                   COMMAND ${FREEPLAY_INTERPRETER} -B ${PROJECT_SOURCE_DIR}/core/python/outside_hdf5.py $<TARGET_FILE:freeplay_results>
                           ${hdf5_library} ${hdf5_package} ${CMAKE_SYSTEM_PROCESSOR} ${outside_hdf5})
target_sources(freeplay_python PRIVATE ${outside_hdf5})
set_source_files_properties(${outside_hdf5} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
find_library(EXPAT_SHARED NAMES libexpat.so expat REQUIRED)
target_link_libraries(freeplay_python PRIVATE -Wl,--no-as-needed ${EXPAT_SHARED} -Wl,--as-needed freeplay_load freeplay_results
                                              freeplay_convert freeplay_drawing freeplay_analysis freeplay_study
                                              freeplay_contract freeplay_report freeplay_job)
freeplay_builtins(freeplay_python OFF)
# Places that the loader moves are kept packed. It shows nothing but its entry, and binds what it is made of to itself: no other
# library of the interpreter gets between.
# The rooms are compiled for programs, to which data of other libraries is as near as their own: that of the C++ library
# comes with them.
# Code and constants follow each other without empty pages between.
target_link_options(freeplay_python PRIVATE -Wl,--exclude-libs,ALL -Wl,-Bsymbolic -Wl,--gc-sections -static-libstdc++
                                            -Wl,-z,pack-relative-relocs -Wl,-z,noseparate-code
                                            -Wl,--version-script=${PROJECT_SOURCE_DIR}/core/python/exported.map)

# The files of the package are used where they stand: what is changed there is so at once.
file(GLOB python_files CONFIGURE_DEPENDS core/python/freeplay/*.py core/python/freeplay/py.typed core/python/freeplay/*.pyi)
file(MAKE_DIRECTORY ${python_package})
foreach(file IN LISTS python_files)
  get_filename_component(name ${file} NAME)
  file(CREATE_LINK ${file} ${python_package}/${name} SYMBOLIC)
endforeach()

# For Debian's interpreter, of which the extension fits one version.
execute_process(COMMAND ${FREEPLAY_INTERPRETER} -c "import sys; a, b = sys.version_info[:2]; print(f'python3 (>= {a}.{b}), python3 (<< {a}.{b + 1})', end='')"
                OUTPUT_VARIABLE python_depends COMMAND_ERROR_IS_FATAL ANY)
string(APPEND python_depends ", ${hdf5_package}")
set(python_folder lib/python3/dist-packages/freeplay)
install(TARGETS freeplay_python LIBRARY DESTINATION ${python_folder} COMPONENT python EXCLUDE_FROM_ALL)
install(FILES ${python_files} DESTINATION ${python_folder} COMPONENT python EXCLUDE_FROM_ALL)
