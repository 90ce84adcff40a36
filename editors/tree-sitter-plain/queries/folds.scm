; Blocks fold by the language server, which knows where subprograms and cycles end.
