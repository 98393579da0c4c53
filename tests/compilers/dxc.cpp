// DXC as a command over its library: `dxc ARGUMENTS -Fo OUTPUT INPUT`, in any order. fetch.sh compiles it; Linux packages have only the library.
#include <cstdint>
#include <cstring>
#include <cwchar>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>
#define __EMULATE_UUID 1
#include "dxcapi.h"

int main(int count, char **arguments) {
    std::string output, input;
    std::vector<std::wstring> words;
    for (int at = 1; at < count; ++at) {
        std::string word = arguments[at];
        if (word == "--version") {
            std::puts("dxc over its library");
            return 0;
        }
        if (word == "-Fo" && at + 1 < count) {
            output = arguments[++at];
            continue;
        }
        if (word[0] != '-' && std::filesystem::is_regular_file(word)) input = word;
        words.emplace_back(word.begin(), word.end());
    }
    if (input.empty()) {
        std::fputs("no file to compile\n", stderr);
        return 1;
    }
    void *library = dlopen(DXC_LIBRARY, RTLD_NOW);
    if (!library) {
        std::fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    auto create = reinterpret_cast<DxcCreateInstanceProc>(dlsym(library, "DxcCreateInstance"));
    CComPtr<IDxcCompiler3> compiler;
    CComPtr<IDxcUtils> utils;
    create(CLSID_DxcCompiler, IID_PPV_ARGS(&compiler));
    create(CLSID_DxcUtils, IID_PPV_ARGS(&utils));
    CComPtr<IDxcIncludeHandler> includes;
    utils->CreateDefaultIncludeHandler(&includes);
    std::ifstream file(input, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(file)), {});
    std::vector<const wchar_t *> pointers;
    for (auto &word : words) pointers.push_back(word.c_str());
    DxcBuffer source{text.data(), text.size(), DXC_CP_UTF8};
    CComPtr<IDxcResult> result;
    compiler->Compile(&source, pointers.data(), uint32_t(pointers.size()), includes, IID_PPV_ARGS(&result));
    CComPtr<IDxcBlobUtf8> errors;
    result->GetOutput(DXC_OUT_ERRORS, IID_PPV_ARGS(&errors), nullptr);
    if (errors && errors->GetStringLength()) std::fputs(errors->GetStringPointer(), stderr);
    HRESULT status = 0;
    result->GetStatus(&status);
    if (status != 0) return 1;
    CComPtr<IDxcBlob> object;
    result->GetOutput(DXC_OUT_OBJECT, IID_PPV_ARGS(&object), nullptr);
    std::ofstream(output, std::ios::binary).write(static_cast<const char *>(object->GetBufferPointer()), object->GetBufferSize());
    std::_Exit(0);
}
