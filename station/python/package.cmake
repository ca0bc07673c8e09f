# The Python package `turnpoint`: the module `physics`, readers of the station's data, its fits, and their documentation. It is
# complete in build/PRESET/python, so that PYTHONPATH can point there.
set(PYBIND11_FINDPYTHON ON)
if(NOT SKBUILD)
  set(Python_EXECUTABLE /usr/bin/python3)  # Debian's own Python, for which the Debian package is built
endif()
find_package(pybind11 REQUIRED)
set(turnpoint_python_folder ${CMAKE_BINARY_DIR}/python/turnpoint)
set(physics_python ${CMAKE_SOURCE_DIR}/physics/python)
set(station_python ${CMAKE_SOURCE_DIR}/station/python)

pybind11_add_module(turnpoint_python_physics NO_EXTRAS ${physics_python}/module.cpp ${physics_python}/surface.cpp
  ${physics_python}/field.cpp ${physics_python}/map.cpp ${physics_python}/design.cpp)
target_link_libraries(turnpoint_python_physics PRIVATE turnpoint_physics)
set_target_properties(turnpoint_python_physics PROPERTIES OUTPUT_NAME physics)
pybind11_add_module(turnpoint_python_store NO_EXTRAS ${station_python}/store_module.cpp ${station_python}/tables.cpp)
target_link_libraries(turnpoint_python_store PRIVATE turnpoint_collector turnpoint_store)
set_target_properties(turnpoint_python_store PROPERTIES OUTPUT_NAME _store)
pybind11_add_module(turnpoint_python_analysis NO_EXTRAS ${station_python}/analysis_module.cpp)
target_link_libraries(turnpoint_python_analysis PRIVATE turnpoint_analysis turnpoint_core)
set_target_properties(turnpoint_python_analysis PROPERTIES OUTPUT_NAME _analysis)
set(turnpoint_python_modules turnpoint_python_physics turnpoint_python_store turnpoint_python_analysis)
set_target_properties(${turnpoint_python_modules} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${turnpoint_python_folder})

set(turnpoint_python_files ${station_python}/turnpoint/__init__.py ${station_python}/turnpoint/_read.py
  ${station_python}/turnpoint/analysis.py ${station_python}/turnpoint/_analysis.pyi ${station_python}/turnpoint/py.typed ${station_python}/turnpoint/_store.pyi ${physics_python}/physics.pyi)
foreach(file IN LISTS turnpoint_python_files)
  cmake_path(GET file FILENAME name)
  configure_file(${file} ${turnpoint_python_folder}/${name} COPYONLY)
endforeach()

if(SKBUILD)
  set(turnpoint_python_install turnpoint)  # folder of the package inside the wheel
else()
  set(turnpoint_python_install lib/python3/dist-packages/turnpoint)
endif()
install(TARGETS ${turnpoint_python_modules} LIBRARY DESTINATION ${turnpoint_python_install} COMPONENT python)
install(FILES ${turnpoint_python_files} DESTINATION ${turnpoint_python_install} COMPONENT python)
