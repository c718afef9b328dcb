set(MAPPER_PIPELINE_TESTS mapper_test.cpp mapper_config_test.cpp)
