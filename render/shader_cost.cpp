#include "render/shader_cost.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GLSL.std.450.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cstdint>
#include <glslang/SPIRV/spirv.hpp>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace ltcfit {
namespace {

constexpr spv_target_env kEnvironment = SPV_ENV_OPENGL_4_5;

std::vector<std::uint32_t> compile(const std::string& source) {
  static const bool initialized = glslang::InitializeProcess();
  if (!initialized) throw std::runtime_error("glslang does not start");
  glslang::TShader shader(EShLangFragment);
  const char* text = source.c_str();
  shader.setStrings(&text, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, EShLangFragment, glslang::EShClientOpenGL, 450);
  shader.setEnvClient(glslang::EShClientOpenGL, glslang::EShTargetOpenGL_450);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
  shader.setAutoMapLocations(true);
  shader.setAutoMapBindings(true);
  if (!shader.parse(GetDefaultResources(), 450, false, EShMsgSpvRules))
    throw std::runtime_error(fmt::format("the shader does not compile:\n{}", shader.getInfoLog()));
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(EShMsgSpvRules) || !program.mapIO())
    throw std::runtime_error(fmt::format("the shader does not link:\n{}", program.getInfoLog()));
  std::vector<std::uint32_t> module;
  glslang::GlslangToSpv(*program.getIntermediate(EShLangFragment), module);
  return module;
}

// The optimiser unrolls only what the source asks it to, drivers what they can.
void askToUnroll(std::vector<std::uint32_t>* module) {
  constexpr std::size_t kHeaderWords = 5;
  constexpr std::size_t kLoopControl = 3;
  for (std::size_t i = kHeaderWords; i < module->size(); i += (*module)[i] >> 16)
    if (((*module)[i] & 0xffff) == spv::OpLoopMerge) (*module)[i + kLoopControl] = spv::LoopControlUnrollMask;
}

void optimize(std::vector<std::uint32_t>* module) {
  askToUnroll(module);
  spvtools::Optimizer optimizer(kEnvironment);
  std::string log;
  optimizer.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&,
                                   const char* text) { log += fmt::format("{}\n", text); });
  // Twice: arrays can only become registers once the loops over them are unrolled.
  optimizer.RegisterPerformancePasses();
  optimizer.RegisterPerformancePasses();
  if (!optimizer.Run(module->data(), module->size(), module))
    throw std::runtime_error(fmt::format("the shader cannot be optimised:\n{}", log));
}

struct Instruction {
  spv::Op op;
  std::uint32_t type;
  std::uint32_t result;
  std::vector<std::uint32_t> operands;  // those behind type and result, first word of each
};

// Declarations, registers, memory, structure of branches (which their conditions count for), and negation, a
// modifier of operands.
bool isFree(spv::Op op) {
  switch (op) {
    case spv::OpNop:
    case spv::OpUndef:
    case spv::OpSource:
    case spv::OpSourceContinued:
    case spv::OpSourceExtension:
    case spv::OpModuleProcessed:
    case spv::OpName:
    case spv::OpMemberName:
    case spv::OpString:
    case spv::OpLine:
    case spv::OpNoLine:
    case spv::OpCapability:
    case spv::OpExtension:
    case spv::OpExtInstImport:
    case spv::OpMemoryModel:
    case spv::OpEntryPoint:
    case spv::OpExecutionMode:
    case spv::OpDecorate:
    case spv::OpMemberDecorate:
    case spv::OpDecorationGroup:
    case spv::OpGroupDecorate:
    case spv::OpGroupMemberDecorate:
    case spv::OpTypeVoid:
    case spv::OpTypeBool:
    case spv::OpTypeInt:
    case spv::OpTypeFloat:
    case spv::OpTypeVector:
    case spv::OpTypeMatrix:
    case spv::OpTypeImage:
    case spv::OpTypeSampler:
    case spv::OpTypeSampledImage:
    case spv::OpTypeArray:
    case spv::OpTypeRuntimeArray:
    case spv::OpTypeStruct:
    case spv::OpTypePointer:
    case spv::OpTypeFunction:
    case spv::OpConstantTrue:
    case spv::OpConstantFalse:
    case spv::OpConstant:
    case spv::OpConstantComposite:
    case spv::OpConstantNull:
    case spv::OpFunction:
    case spv::OpFunctionParameter:
    case spv::OpFunctionEnd:
    case spv::OpVariable:
    case spv::OpLoad:
    case spv::OpStore:
    case spv::OpCopyMemory:
    case spv::OpAccessChain:
    case spv::OpInBoundsAccessChain:
    case spv::OpVectorExtractDynamic:
    case spv::OpVectorInsertDynamic:
    case spv::OpVectorShuffle:
    case spv::OpCompositeConstruct:
    case spv::OpCompositeExtract:
    case spv::OpCompositeInsert:
    case spv::OpCopyObject:
    case spv::OpTranspose:
    case spv::OpBitcast:
    case spv::OpSampledImage:
    case spv::OpImage:
    case spv::OpFNegate:
    case spv::OpSNegate:
    case spv::OpPhi:
    case spv::OpLabel:
    case spv::OpLoopMerge:
    case spv::OpSelectionMerge:
    case spv::OpBranch:
    case spv::OpKill:
    case spv::OpReturn:
    case spv::OpReturnValue:
    case spv::OpUnreachable:
      return true;
    default:
      return false;
  }
}

class Counter {
 public:
  explicit Counter(const std::vector<std::uint32_t>& module) {
    const spvtools::Context context(kEnvironment);
    const spv_result_t ok = spvBinaryParse(
        context.CContext(), this, module.data(), module.size(), nullptr,
        [](void* self, const spv_parsed_instruction_t* i) {
          static_cast<Counter*>(self)->read(*i);
          return SPV_SUCCESS;
        },
        nullptr);
    if (ok != SPV_SUCCESS) throw std::runtime_error("the compiled shader cannot be read");
  }

  ShaderCost count() {
    for (const Instruction& i : instructions_) add(i);
    return cost_;
  }

 private:
  void read(const spv_parsed_instruction_t& parsed) {
    Instruction i{static_cast<spv::Op>(parsed.opcode), parsed.type_id, parsed.result_id, {}};
    for (std::uint16_t k = 0; k < parsed.num_operands; ++k) {
      const spv_parsed_operand_t& operand = parsed.operands[k];
      if (operand.type == SPV_OPERAND_TYPE_TYPE_ID || operand.type == SPV_OPERAND_TYPE_RESULT_ID) continue;
      i.operands.push_back(parsed.words[operand.offset]);
      // names and decorations come before all types, and are no uses
      if (operand.type == SPV_OPERAND_TYPE_ID && !sizes_.empty()) ++uses_[i.operands.back()];
    }
    if (i.op == spv::OpTypeVector || i.op == spv::OpTypeMatrix)
      sizes_[i.result] = size(i.operands[0]) * static_cast<int>(i.operands[1]);
    else if (i.op == spv::OpTypeFloat || i.op == spv::OpTypeInt || i.op == spv::OpTypeBool ||
             i.op == spv::OpTypeVoid)
      sizes_[i.result] = 1;
    if (i.result != 0) {
      indices_[i.result] = instructions_.size();
    }
    instructions_.push_back(std::move(i));
  }

  // Scalars in a type.
  int size(std::uint32_t type) const {
    const auto found = sizes_.find(type);
    return found == sizes_.end() ? 1 : found->second;
  }
  int sizeOfValue(std::uint32_t id) const { return size(instructions_[indices_.at(id)].type); }

  bool isProductUsedOnce(std::uint32_t id) const {
    const spv::Op op = instructions_[indices_.at(id)].op;
    return (op == spv::OpFMul || op == spv::OpVectorTimesScalar) && uses_.at(id) == 1;
  }

  void addSpecial(const char* name, int n) { cost_.special[name] += n; }

  void add(const Instruction& i) {
    const int n = size(i.type);
    switch (i.op) {
      case spv::OpImageSampleImplicitLod:
      case spv::OpImageSampleExplicitLod:
      case spv::OpImageSampleDrefImplicitLod:
      case spv::OpImageSampleDrefExplicitLod:
      case spv::OpImageSampleProjImplicitLod:
      case spv::OpImageSampleProjExplicitLod:
      case spv::OpImageSampleProjDrefImplicitLod:
      case spv::OpImageSampleProjDrefExplicitLod:
      case spv::OpImageFetch:
      case spv::OpImageGather:
      case spv::OpImageDrefGather:
        ++cost_.fetches;
        break;
      case spv::OpImageQuerySizeLod:
      case spv::OpImageQuerySize:
        addSpecial("textureSize", 1);
        break;
      case spv::OpFAdd:
      case spv::OpFSub:
        if (!isProductUsedOnce(i.operands[0]) && !isProductUsedOnce(i.operands[1])) cost_.arithmetic += n;
        break;
      case spv::OpFMul:
      case spv::OpVectorTimesScalar:
      case spv::OpMatrixTimesScalar:
      case spv::OpOuterProduct:
      case spv::OpIAdd:
      case spv::OpISub:
      case spv::OpIMul:
      case spv::OpConvertFToS:
      case spv::OpConvertFToU:
      case spv::OpConvertSToF:
      case spv::OpConvertUToF:
      case spv::OpShiftLeftLogical:
      case spv::OpShiftRightLogical:
      case spv::OpShiftRightArithmetic:
      case spv::OpBitwiseAnd:
      case spv::OpBitwiseOr:
      case spv::OpBitwiseXor:
      case spv::OpNot:
      case spv::OpLogicalAnd:
      case spv::OpLogicalOr:
      case spv::OpLogicalNot:
      case spv::OpLogicalEqual:
      case spv::OpLogicalNotEqual:
      case spv::OpIsNan:
      case spv::OpIsInf:
      case spv::OpIEqual:
      case spv::OpINotEqual:
      case spv::OpSLessThan:
      case spv::OpSLessThanEqual:
      case spv::OpSGreaterThan:
      case spv::OpSGreaterThanEqual:
      case spv::OpULessThan:
      case spv::OpULessThanEqual:
      case spv::OpUGreaterThan:
      case spv::OpUGreaterThanEqual:
      case spv::OpFOrdEqual:
      case spv::OpFOrdNotEqual:
      case spv::OpFUnordEqual:
      case spv::OpFUnordNotEqual:
      case spv::OpFOrdLessThan:
      case spv::OpFOrdLessThanEqual:
      case spv::OpFOrdGreaterThan:
      case spv::OpFOrdGreaterThanEqual:
      case spv::OpFUnordLessThan:
      case spv::OpFUnordLessThanEqual:
      case spv::OpFUnordGreaterThan:
      case spv::OpFUnordGreaterThanEqual:
      case spv::OpDPdx:
      case spv::OpDPdy:
      case spv::OpDPdxFine:
      case spv::OpDPdyFine:
      case spv::OpDPdxCoarse:
      case spv::OpDPdyCoarse:
        cost_.arithmetic += n;
        break;
      case spv::OpFwidth:
      case spv::OpFwidthFine:
      case spv::OpFwidthCoarse:
        cost_.arithmetic += 3 * n;  // both derivatives and their sum
        break;
      case spv::OpDot:
      case spv::OpAny:
      case spv::OpAll:
        cost_.arithmetic += sizeOfValue(i.operands[0]);
        break;
      case spv::OpMatrixTimesVector:
        cost_.arithmetic += sizeOfValue(i.operands[0]);
        break;
      case spv::OpVectorTimesMatrix:
        cost_.arithmetic += sizeOfValue(i.operands[1]);
        break;
      case spv::OpMatrixTimesMatrix: {
        const int rows = size(instructions_[indices_.at(i.type)].operands[0]);
        cost_.arithmetic += sizeOfValue(i.operands[0]) * n / rows;
        break;
      }
      case spv::OpFDiv:
      case spv::OpSDiv:
      case spv::OpUDiv:
      case spv::OpFMod:
      case spv::OpFRem:
      case spv::OpSMod:
      case spv::OpSRem:
      case spv::OpUMod:
        addSpecial("division", n);
        break;
      case spv::OpSelect:
        cost_.selects += n;
        break;
      case spv::OpBranchConditional:
      case spv::OpSwitch:
        ++cost_.branches;
        break;
      case spv::OpExtInst:
        addFunction(i, n);
        break;
      case spv::OpFunctionCall:
        throw std::runtime_error("a call is left in the optimised shader: its cost would not be counted");
      default:
        if (isFree(i.op)) break;
        throw std::runtime_error(fmt::format("no cost is known of Op{} of SPIR-V",
                                             spvOpcodeString(static_cast<std::uint32_t>(i.op))));
    }
  }

  // operands: the set, the function, its arguments
  void addFunction(const Instruction& i, int n) {
    const int argument = sizeOfValue(i.operands[2]);
    switch (i.operands[1]) {
      case GLSLstd450FAbs:
      case GLSLstd450SAbs:
        break;
      case GLSLstd450FMin:
      case GLSLstd450FMax:
      case GLSLstd450NMin:
      case GLSLstd450NMax:
      case GLSLstd450SMin:
      case GLSLstd450SMax:
      case GLSLstd450Floor:
      case GLSLstd450Ceil:
      case GLSLstd450Trunc:
      case GLSLstd450Round:
      case GLSLstd450RoundEven:
      case GLSLstd450Fract:
      case GLSLstd450FSign:
      case GLSLstd450Step:
      case GLSLstd450Fma:
        cost_.arithmetic += n;
        break;
      case GLSLstd450FMix:
      case GLSLstd450FClamp:
      case GLSLstd450NClamp:
      case GLSLstd450SClamp:
        cost_.arithmetic += 2 * n;
        break;
      case GLSLstd450Cross:
        cost_.arithmetic += 6;
        break;
      case GLSLstd450Length:
        cost_.arithmetic += argument;
        addSpecial("sqrt", 1);
        break;
      case GLSLstd450Distance:
        cost_.arithmetic += 2 * argument;
        addSpecial("sqrt", 1);
        break;
      case GLSLstd450Normalize:
        cost_.arithmetic += 2 * argument;
        addSpecial("inversesqrt", 1);
        break;
      case GLSLstd450Sqrt:
        addSpecial("sqrt", n);
        break;
      case GLSLstd450InverseSqrt:
        addSpecial("inversesqrt", n);
        break;
      case GLSLstd450Atan2:
        addSpecial("atan2", n);
        break;
      case GLSLstd450Atan:
        addSpecial("atan", n);
        break;
      case GLSLstd450Acos:
        addSpecial("acos", n);
        break;
      case GLSLstd450Asin:
        addSpecial("asin", n);
        break;
      case GLSLstd450Sin:
        addSpecial("sin", n);
        break;
      case GLSLstd450Cos:
        addSpecial("cos", n);
        break;
      case GLSLstd450Pow:
        addSpecial("pow", n);
        break;
      case GLSLstd450Exp:
      case GLSLstd450Exp2:
        addSpecial("exp", n);
        break;
      case GLSLstd450Log:
      case GLSLstd450Log2:
        addSpecial("log", n);
        break;
      default:
        throw std::runtime_error(
            fmt::format("no cost is known of function {} of GLSL.std.450", i.operands[1]));
    }
  }

  std::vector<Instruction> instructions_;
  std::unordered_map<std::uint32_t, std::size_t> indices_;
  std::unordered_map<std::uint32_t, int> sizes_;
  std::unordered_map<std::uint32_t, int> uses_;
  ShaderCost cost_;
};

}  // namespace

int ShaderCost::expanded() const {
  static const std::map<std::string, int> kLengths{{"atan2", 25}, {"atan", 15},    {"acos", 15}, {"asin", 15},
                                                   {"pow", 3},    {"division", 2}, {"exp", 2}};
  int sum = total();
  for (const auto& [name, n] : special) {
    const auto found = kLengths.find(name);
    if (found != kLengths.end()) sum += n * (found->second - 1);
  }
  return sum;
}

ShaderCost shaderCost(const std::string& fragmentSource) {
  std::vector<std::uint32_t> module = compile(fragmentSource);
  optimize(&module);
  return Counter(module).count();
}

}  // namespace ltcfit
