-- File types of Bahn, its language server, and highlighting by the grammars where they are installed.
vim.filetype.add({
  extension = {
    H = 'tnc_plain',
    I = 'tnc_iso',
    nc = 'din_66025',
    ['900'] = 'system_900',
    PLC = 'tnc_plc', plc = 'tnc_plc',
    MP = 'tnc_parameters', mp = 'tnc_parameters',
    lis = 'tf_channel',
  },
  -- Small letters are those of C, too: a program begins with BEGIN PGM.
  pattern = {
    ['.*%.h'] = {
      function(_, buffer)
        local first = vim.api.nvim_buf_get_lines(buffer, 0, 1, false)[1] or ''
        return first:upper():match('BEGIN%s+PGM') and 'tnc_plain' or nil
      end,
      { priority = 10 },
    },
  },
})

if vim.lsp.enable then
  vim.lsp.enable('bahn')
end

vim.api.nvim_create_autocmd('FileType', {
  pattern = { 'tnc_plain', 'tnc_plc' },
  callback = function(event)
    vim.bo[event.buf].commentstring = '; %s'
    -- Without the parser the colours of the language server are there.
    pcall(vim.treesitter.start, event.buf)
  end,
})
