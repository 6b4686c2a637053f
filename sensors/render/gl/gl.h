#pragma once
#include <GL/glcorearb.h>

#include "sensors/render/gl/gl_context.h"

// Function pointers of OpenGL 4.5 core: libGL is never linked.
#define DMISE_GL_FUNCTIONS(F)                                  \
  F(PFNGLGETSTRINGPROC, GetString)                             \
  F(PFNGLGETERRORPROC, GetError)                               \
  F(PFNGLCREATESHADERPROC, CreateShader)                       \
  F(PFNGLSHADERSOURCEPROC, ShaderSource)                       \
  F(PFNGLCOMPILESHADERPROC, CompileShader)                     \
  F(PFNGLGETSHADERIVPROC, GetShaderiv)                         \
  F(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)               \
  F(PFNGLDELETESHADERPROC, DeleteShader)                       \
  F(PFNGLCREATEPROGRAMPROC, CreateProgram)                     \
  F(PFNGLATTACHSHADERPROC, AttachShader)                       \
  F(PFNGLLINKPROGRAMPROC, LinkProgram)                         \
  F(PFNGLGETPROGRAMIVPROC, GetProgramiv)                       \
  F(PFNGLUSEPROGRAMPROC, UseProgram)                           \
  F(PFNGLUNIFORM4FPROC, Uniform4f)                             \
  F(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)           \
  F(PFNGLCREATEVERTEXARRAYSPROC, CreateVertexArrays)           \
  F(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                 \
  F(PFNGLGENBUFFERSPROC, GenBuffers)                           \
  F(PFNGLBINDBUFFERPROC, BindBuffer)                           \
  F(PFNGLBUFFERDATAPROC, BufferData)                           \
  F(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer)         \
  F(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray) \
  F(PFNGLVERTEXATTRIBDIVISORPROC, VertexAttribDivisor)         \
  F(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                 \
  F(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                 \
  F(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers)               \
  F(PFNGLBINDRENDERBUFFERPROC, BindRenderbuffer)               \
  F(PFNGLRENDERBUFFERSTORAGEPROC, RenderbufferStorage)         \
  F(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer) \
  F(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus)   \
  F(PFNGLVIEWPORTPROC, Viewport)                               \
  F(PFNGLCLIPCONTROLPROC, ClipControl)                         \
  F(PFNGLCLEARCOLORPROC, ClearColor)                           \
  F(PFNGLCLEARDEPTHPROC, ClearDepth)                           \
  F(PFNGLCLEARPROC, Clear)                                     \
  F(PFNGLENABLEPROC, Enable)                                   \
  F(PFNGLDISABLEPROC, Disable)                                 \
  F(PFNGLPOLYGONOFFSETPROC, PolygonOffset)                     \
  F(PFNGLDEPTHFUNCPROC, DepthFunc)                             \
  F(PFNGLBLENDFUNCPROC, BlendFunc)                             \
  F(PFNGLSCISSORPROC, Scissor)                                 \
  F(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)         \
  F(PFNGLDRAWELEMENTSPROC, DrawElements)                       \
  F(PFNGLPIXELSTOREIPROC, PixelStorei)                         \
  F(PFNGLREADPIXELSPROC, ReadPixels)                           \
  F(PFNGLUNIFORMMATRIX3FVPROC, UniformMatrix3fv)               \
  F(PFNGLCREATETEXTURESPROC, CreateTextures)                   \
  F(PFNGLTEXTURESTORAGE2DPROC, TextureStorage2D)               \
  F(PFNGLTEXTURESUBIMAGE2DPROC, TextureSubImage2D)             \
  F(PFNGLGENERATETEXTUREMIPMAPPROC, GenerateTextureMipmap)     \
  F(PFNGLTEXTUREPARAMETERIPROC, TextureParameteri)             \
  F(PFNGLBINDTEXTUREUNITPROC, BindTextureUnit)

namespace dmise {

struct Gl {
#define DMISE_GL_MEMBER(type, name) type name = nullptr;
  DMISE_GL_FUNCTIONS(DMISE_GL_MEMBER)
#undef DMISE_GL_MEMBER
};

/// Loads the functions of the current context. Throws `Error` naming a missing one.
Gl load_gl(GlContext& context);

/// Description for the log: "OSMesa, llvmpipe (...), OpenGL 4.5 ...".
std::string description_of(const Gl& gl, const GlContext& context);

}  // namespace dmise
