# A fuzzer fuzz_KIND.c for each kind of files that eclat reads: with libFuzzer (ECLAT_FUZZ), or over its corpus as a test.
set(fuzzers gltf image checkpoint scenarios)

# Sources of the rooms that a fuzzer needs besides those of a host library.
set(fuzz_more_of_checkpoint ${sources_of_store})
foreach(name format names settings)
  list(APPEND fuzz_reports ${CMAKE_SOURCE_DIR}/host/report/${name}.c)
endforeach()
list(APPEND fuzz_more_of_checkpoint ${fuzz_reports})
foreach(name scenarios entries given render_request render_settle option render_options render_setters denoise_choice numbers channel_list outputs frames)
  list(APPEND fuzz_more_of_scenarios ${CMAKE_SOURCE_DIR}/host/jobs/${name}.c)
endforeach()
list(APPEND fuzz_more_of_scenarios ${fuzz_reports} ${CMAKE_SOURCE_DIR}/host/store/identity.c)

function(eclat_fuzzer target kind library)
  add_executable(${target} ${CMAKE_SOURCE_DIR}/tests/robust/fuzz_${kind}.c ${CMAKE_SOURCE_DIR}/tests/robust/fuzz_options.c ${fuzz_more_of_${kind}} ${ARGN})
  target_link_libraries(${target} PRIVATE ${library} ${CJSON_LIBRARY})
endfunction()
