set(MAPPER_PIPELINE_SOURCES mapper.cpp mapper_config.cpp stages.cpp)
