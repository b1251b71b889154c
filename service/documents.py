"""The JSON documents that the service answers with; OpenAPI, and with it the page's types, come from here."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, Field


class Finding(BaseModel):
    """One problem or warning."""

    pointer: str = Field(description="JSON pointer into the request's body; empty: the whole of it")
    expected: str
    found: str


class ProblemDocument(BaseModel):
    """What every error looks like (RFC 9457)."""

    type: str = Field(description="about:blank, or a URN of the kind of problem")
    title: str
    status: int
    detail: str
    problems: list[Finding]


class Health(BaseModel):
    status: Literal["ok"]
    version: str
    kernels: Literal["compiling", "ready"] = Field(description="the first render waits until they are ready")
    renders: int = Field(description="renders that run or wait now")


class Validation(BaseModel):
    valid: bool
    problems: list[Finding]
    warnings: list[Finding] = Field(description="where the picture will be an approximation")


class CompiledPattern(BaseModel):
    id: str = Field(description="hash of the pattern's content")
    grooves: int = Field(description="as listed, before repeats")
    pieces: int = Field(description="lines and circular arcs, after repeats")
    bytes: int = Field(description="of all tables together")
    grid: tuple[int, int] = Field(description="cells along p and q")
    seconds: float = Field(description="spent on this request; nearly nothing when it was compiled before")
    warnings: list[Finding]


class UploadedMesh(BaseModel):
    id: str = Field(description="hash of the file's content")
    file: str = Field(description="what a scene's `shape.file` says to use it")
    bytes: int


class UploadedEnvmap(BaseModel):
    id: str = Field(description="hash of the file's content")
    file: str = Field(description="what an envmap's `file` says to use it")
    bytes: int


class Examples(BaseModel):
    examples: list[str] = Field(description="names, sorted")
