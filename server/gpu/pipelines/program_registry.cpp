#include "gpu/pipelines/program_registry.hpp"

#include <utility>

namespace heliograph::gpu {

void ProgramRegistry::remove(Program& program) {
  const Lock held = lock();
  programs_.erase(&program);
}

ShaderBinary ProgramRegistry::current(const ShaderBinary& embedded) const {
  const auto replaced = replaced_.find(embedded.name);
  return replaced == replaced_.end() ? embedded : ShaderBinary{embedded.name, replaced->second};
}

void ProgramRegistry::replace(const std::string& name, std::vector<std::uint32_t> words) {
  replaced_[name] = std::move(words);
}

void RegisteredProgram::enter(ProgramRegistry& registry, Program& program) {
  registry.add(program);
  registry_ = &registry;
  program_ = &program;
}

RegisteredProgram::~RegisteredProgram() {
  if (registry_) registry_->remove(*program_);
}

}  // namespace heliograph::gpu
