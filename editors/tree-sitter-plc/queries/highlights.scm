(comment) @comment
(command) @keyword
(bracket) @punctuation.bracket
(operand) @variable
(constant) @number
(string) @string
(file) @string.special.path
(label (name) @function)
(field (name) @function)
(jump (name) @function.call)
(link (name) @function)
