// Starts `bahn lsp` and lets it speak with the editor. Plain JavaScript: nothing is built.
const { workspace } = require('vscode')
const { LanguageClient, TransportKind } = require('vscode-languageclient/node')

const LANGUAGES = ['tnc-plain', 'tnc-iso', 'din-66025', 'system-900', 'tnc-plc', 'tnc-parameters', 'tf-channel']
let client

/** The settings that the server knows. */
function settings() {
  const all = workspace.getConfiguration('bahn')
  const names = ['model', 'strict', 'skipUnknown', 'comma', 'isoStep']
  return Object.fromEntries(names.map((name) => [name, all.get(name)]))
}

exports.activate = async () => {
  const command = workspace.getConfiguration('bahn').get('command')
  const server = { command, args: ['lsp'], transport: TransportKind.stdio }
  client = new LanguageClient('bahn', 'Bahn', server, {
    documentSelector: LANGUAGES.map((language) => ({ language })),
    initializationOptions: settings(),
    synchronize: { configurationSection: 'bahn' },
  })
  await client.start()
}

exports.deactivate = () => client?.stop()
