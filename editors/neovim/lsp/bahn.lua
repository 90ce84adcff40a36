-- The language server of Bahn, for Neovim 0.11 and later: vim.lsp.enable('bahn') takes this file.
return {
  cmd = { 'bahn', 'lsp' },
  filetypes = { 'tnc_plain', 'tnc_iso', 'din_66025', 'system_900', 'tnc_plc', 'tnc_parameters', 'tf_channel' },
  root_markers = { 'machine.toml', '.git' },
  -- The names that the server knows its languages by.
  get_language_id = function(_, filetype)
    return (filetype:gsub('_', '-'))
  end,
  -- init_options = { model = 'tnc360', isoStep = 5 },
}
